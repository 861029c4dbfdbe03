#include "planner/measured/strip_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_GIF
#define STBI_NO_HDR
#define STBI_NO_PSD
#define STBI_NO_TGA
#include <stb/stb_image.h>

#include "mapping/error.hpp"

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

}  // namespace

GreyImage read_image(const std::filesystem::path& file) {
  GreyImage image;
  int channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> levels(
      stbi_load(file.c_str(), &image.width, &image.height, &channels, 1), &stbi_image_free);
  if (!levels)
    throw WrongInput(fmt::format("{}: cannot be read as an image: {}", file.string(), stbi_failure_reason()));
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
