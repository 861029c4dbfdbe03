#include "planner/base/text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "mapping/error.hpp"

namespace drapeplan {
namespace {

constexpr std::string_view kReplacement = "\uFFFD";

struct Character {
  char32_t code = 0;
  size_t bytes = 0;  ///< 0: the text does not start with a character in UTF-8
};

/// The character that `text`, which is not empty, starts with (RFC 3629).
Character first_character(std::string_view text) {
  const auto byte = [text](size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return {char32_t(lead), 1};
  const size_t bytes = lead < 0xC0 ? 0 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : lead < 0xF8 ? 4 : 0;
  if (bytes == 0) return {};
  char32_t code = lead & (0x7FU >> bytes);
  for (size_t k = 1; k < bytes; ++k) {
    if ((byte(k) & 0xC0U) != 0x80) return {};
    code = code << 6U | (byte(k) & 0x3FU);
  }
  constexpr std::array<char32_t, 5> kSmallest{0, 0, 0x80, 0x800,
                                              0x10000};  // below it: a longer form than needed
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kSmallest[bytes] || surrogate || code > 0x10FFFF) return {};
  return {code, bytes};
}

/// Of the characters of UTF-8 (XML 1.0, section 2.2). A carriage return would be read as a line break.
bool allowed_in_xml(char32_t code) {
  return code == '\t' || code == '\n' || (code >= 0x20 && code != 0xFFFE && code != 0xFFFF);
}

}  // namespace

std::string exact(double value) {
  std::array<char, 40> buffer;  // the longest double has 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  const std::string text = fmt::format("{:.{}f}", value, decimals);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

size_t utf8_prefix(std::string_view text) {
  size_t at = 0;
  while (at < text.size()) {
    const size_t bytes = first_character(text.substr(at)).bytes;
    if (bytes == 0) break;
    at += bytes;
  }
  return at;
}

std::string clean_text(std::string_view text) {
  std::string clean;
  while (!text.empty()) {
    const Character character = first_character(text);
    const size_t bytes = std::max<size_t>(character.bytes, 1);
    if (character.bytes > 0 && allowed_in_xml(character.code)) {
      clean += text.substr(0, bytes);
    } else {
      clean += kReplacement;
    }
    text.remove_prefix(bytes);
  }
  return clean;
}

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char c : clean_text(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string quoted_cell(std::string_view text) {
  std::string cell = "\"";
  for (const char c : text) cell += (c == '"' ? "\"\"" : std::string(1, c));
  return cell + '"';
}

std::string markdown_cell(std::string_view text) {
  std::string cell;
  for (const char c : text) cell += (c == '|' ? "\\|" : c == '\n' ? " " : std::string(1, c));
  return cell;
}

FileText read_file(const std::filesystem::path& file, bool pipes) {
  constexpr size_t kMost = size_t(256) << 20U, kPiece = size_t(1) << 16U;  // bytes
  const auto reason = [](int error) { return std::generic_category().message(error); };
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return {{}, reason(errno)};
  if (S_ISDIR(status.st_mode)) return {{}, "it is a folder"};
  if (!S_ISREG(status.st_mode) && !pipes) return {{}, "it is no regular file"};
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) return {{}, reason(errno)};
  FileText result;
  ssize_t count = 1;
  while (count != 0 && result.fault.empty()) {
    const size_t before = result.text.size();
    result.text.resize(before + kPiece);
    count = ::read(descriptor, result.text.data() + before, kPiece);
    if (count < 0 && errno != EINTR) result.fault = reason(errno);
    result.text.resize(before + (count > 0 ? size_t(count) : 0));
    if (result.text.size() > kMost) result.fault = "it is larger than 256 MB";
  }
  ::close(descriptor);
  return result;
}

std::string shown(std::string_view text) {
  constexpr size_t kMost = 40, kLongestCharacter = 4;  // characters, bytes
  std::string clean;
  size_t count = 0;
  while (!text.empty() && count < kMost) {
    const Character character = first_character(text.substr(0, kLongestCharacter));
    const bool printable = character.bytes > 0 && character.code >= 0x20 && character.code != 0x7F &&
                           !(character.code >= 0x80 && character.code < 0xA0);
    const size_t bytes = std::max<size_t>(character.bytes, 1);
    clean += printable ? text.substr(0, bytes) : kReplacement;
    text.remove_prefix(bytes);
    ++count;
  }
  return text.empty() ? clean : clean + "...";
}

void write_text(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path partial = file.string() + ".partial";
  std::FILE* stream = std::fopen(partial.c_str(), "wb");
  bool good = stream != nullptr && std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  int error = good ? 0 : errno;
  if (stream != nullptr && std::fclose(stream) != 0 && good) good = false, error = errno;
  if (good && std::rename(partial.c_str(), file.c_str()) != 0) good = false, error = errno;
  if (good) return;
  if (stream != nullptr) std::remove(partial.c_str());
  throw NotFinished(
      fmt::format("{}: cannot be written: {}", file.string(), std::generic_category().message(error)));
}

}  // namespace drapeplan
