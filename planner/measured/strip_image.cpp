#include "planner/measured/strip_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_GIF
#define STBI_NO_HDR
#define STBI_NO_PSD
#define STBI_NO_TGA
#include <stb/stb_image.h>

#include "mapping/error.hpp"
#include "planner/base/text.hpp"

namespace drapeplan {
namespace {

/// Connected pixels of the strip's colour (neighbours share a side), as indices into the levels.
using Patch = std::vector<int>;

std::vector<Patch> patches_of(const GreyImage& image, const StripImageOptions& options) {
  const auto limit = std::uint8_t(std::clamp(options.threshold, 0.0, 1.0) * 255);
  std::vector<char> open(image.levels.size());
  for (size_t k = 0; k < open.size(); ++k) open[k] = (image.levels[k] > limit) != options.dark;
  std::vector<Patch> patches;
  for (size_t first = 0; first < open.size(); ++first) {
    if (!open[first]) continue;
    Patch patch{int(first)};
    open[first] = 0;
    for (size_t k = 0; k < patch.size(); ++k) {
      const int column = patch[k] % image.width, row = patch[k] / image.width;
      const auto visit = [&](int c, int r) {
        if (c < 0 || r < 0 || c >= image.width || r >= image.height) return;
        const int index = r * image.width + c;
        if (!open[size_t(index)]) return;
        open[size_t(index)] = 0;
        patch.push_back(index);
      };
      visit(column - 1, row), visit(column + 1, row), visit(column, row - 1), visit(column, row + 1);
    }
    if (int(patch.size()) >= options.smallest_area) patches.push_back(std::move(patch));
  }
  std::stable_sort(patches.begin(), patches.end(),
                   [](const Patch& a, const Patch& b) { return a.size() > b.size(); });
  return patches;
}

/// The next number in the head of a PNM file, behind blanks and comments; 0 if there is none.
double head_number(const std::string& bytes, size_t& at) {
  while (at < bytes.size() && (std::isspace(static_cast<unsigned char>(bytes[at])) != 0 || bytes[at] == '#'))
    at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
  double value = 0;
  for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) != 0; ++at)
    value = 10 * value + (bytes[at] - '0');
  return value;
}

/// What the decoder does not look for: it takes pixels that are absent for black, and levels for those of 8 bits.
/// @return what is wrong; empty: nothing.
std::string incomplete_image(const std::string& bytes) {
  if (bytes.starts_with("P5") || bytes.starts_with("P6")) {
    size_t at = 2;
    const double width = head_number(bytes, at), height = head_number(bytes, at), white = head_number(bytes, at);
    if (white != 255) return fmt::format("white is {}; expected 255, that is pixels of 8 bits", white);
    if (!(width > 0 && height > 0)) return fmt::format("it has {} times {} pixels", width, height);
    const double needed = double(at) + 1 + width * height * (bytes[1] == '6' ? 3 : 1);
    if (double(bytes.size()) < needed)
      return fmt::format("it is cut off: {} bytes of {}", bytes.size(), needed);
  }
  if (bytes.starts_with("\xFF\xD8")) {  // JPEG: the scan has no marker but its end
    const size_t scan = bytes.rfind("\xFF\xDA"), end = bytes.rfind("\xFF\xD9");
    if (scan == std::string::npos || end == std::string::npos || end < scan) return "it is cut off";
  }
  return {};
}

}  // namespace

GreyImage read_image(const std::filesystem::path& file) {
  const auto fail = [&file](const std::string& reason) {
    throw WrongInput(fmt::format("{}: cannot be read as an image: {}", file.string(), reason));
  };
  const FileText bytes = read_file(file);
  if (!bytes.fault.empty()) fail(bytes.fault);
  const std::string incomplete = incomplete_image(bytes.text);
  if (!incomplete.empty()) fail(incomplete);
  GreyImage image;
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> levels(
      stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.text.data()), int(bytes.text.size()), &image.width,
                            &image.height, &channels, 1),
      &stbi_image_free);
  if (!levels) fail(stbi_failure_reason());
  image.levels.assign(levels.get(), levels.get() + size_t(image.width) * size_t(image.height));
  return image;
}

std::vector<Eigen::Vector2d> strip_midline(const GreyImage& image, const StripImageOptions& options) {
  constexpr double kComparable = 0.3;  // of the largest patch: not dirt, but a second strip
  constexpr int kFewestColumns = 20;
  constexpr double kLargestShare = 0.5;  // of the picture: not a strip, but the background
  const std::vector<Patch> patches = patches_of(image, options);
  const char* colour = options.dark ? "darker" : "brighter";
  if (patches.empty() || double(patches.front().size()) > kLargestShare * double(image.levels.size()))
    throw WrongInput(fmt::format("shows no strip: {} of it is {} than the threshold",
                                 patches.empty() ? "nothing" : "more than half", colour));
  if (patches.size() > 1 && double(patches[1].size()) > kComparable * double(patches[0].size()))
    throw WrongInput(fmt::format("shows two strips, of {} and {} pixels", patches[0].size(), patches[1].size()));
  const int far_side = options.clamp_right ? 0 : image.width - 1;
  for (const int index : patches.front()) {
    if (index / image.width == image.height - 1 || index % image.width == far_side)
      throw WrongInput(fmt::format("the strip reaches the {} edge of the picture: its tip may lie outside",
                                   index % image.width != far_side ? "lower" : options.clamp_right ? "left" : "right"));
  }
  std::vector<double> sum(size_t(image.width), 0), count(size_t(image.width), 0);
  for (const int index : patches.front()) {
    sum[size_t(index % image.width)] += index / image.width;
    ++count[size_t(index % image.width)];
  }
  std::vector<Eigen::Vector2d> line;
  for (int k = 0; k < image.width; ++k) {
    const int column = options.clamp_right ? image.width - 1 - k : k;
    if (count[size_t(column)] == 0) continue;
    line.emplace_back(options.scale * k, -options.scale * sum[size_t(column)] / count[size_t(column)]);
  }
  if (int(line.size()) < kFewestColumns)
    throw WrongInput(fmt::format("shows no strip: its largest patch is {} pixels wide", line.size()));
  const Eigen::Vector2d origin = line.front();
  for (Eigen::Vector2d& point : line) point -= origin;
  return line;
}

}  // namespace drapeplan
