// Bytes as text (RFC 4648, with padding), for binary arrays inside XML and JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace drapeplan {

inline constexpr std::string_view kBase64Digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string base64(const std::vector<unsigned char>& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t group = 0;
    for (size_t b = 0; b < 3; ++b) group = group << 8 | (k + b < bytes.size() ? bytes[k + b] : 0u);
    for (size_t digit = 0; digit < 4; ++digit) {
      const bool padding = k + digit > bytes.size();
      text += padding ? '=' : kBase64Digits[group >> (18 - 6 * digit) & 63u];
    }
  }
  return text;
}

/// Nothing if the text is not what `base64` writes.
inline std::optional<std::vector<unsigned char>> bytes_of_base64(std::string_view text) {
  if (text.size() % 4 != 0) return {};
  size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::vector<unsigned char> bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t group = 0;
  for (size_t k = 0; k < text.size(); ++k) {
    const bool end = k + padding >= text.size();
    const size_t digit = end ? 0 : kBase64Digits.find(text[k]);
    if (digit == std::string_view::npos) return {};
    group = group << 6 | std::uint32_t(digit);
    if (k % 4 != 3) continue;
    for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<unsigned char>(group >> shift & 255u));
    group = 0;
  }
  for (; padding > 0 && !bytes.empty(); --padding) bytes.pop_back();
  if (base64(bytes) != text) return {};  // bits that are left over
  return bytes;
}

}  // namespace drapeplan
