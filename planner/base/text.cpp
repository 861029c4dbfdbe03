#include "planner/base/text.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <system_error>

#include "mapping/error.hpp"

namespace drapeplan {

std::string exact(double value) {
  std::array<char, 40> buffer;  // the longest double has 24 characters
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\u2013";
  std::array<char, 400> buffer;  // the largest double has 309 digits before the point
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals)
          .ptr;
  std::string text(buffer.data(), end);
  const bool zero = text.find_first_not_of("-0.") == std::string::npos;
  return zero && text.front() == '-' ? text.substr(1) : text;
}

std::string escape_markup(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
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
      case '\n':
      case '\t':
        escaped += c;
        break;
      default:
        escaped += static_cast<unsigned char>(c) < 0x20 ? std::string("\uFFFD") : std::string(1, c);
    }
  }
  return escaped;
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
  throw NotFinished(file.string() + ": cannot be written: " + std::generic_category().message(error));
}

}  // namespace drapeplan
