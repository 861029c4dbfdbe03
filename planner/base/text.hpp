// Small helpers of the files we write: numbers, escaping, whole files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace drapeplan {

/// Shortest decimal text that reads back as the same bits.
std::string exact(double value);

/// `value` with `decimals` digits after the point, never "-0.0"; an en dash where it is not finite.
std::string fixed(double value, int decimals);

/// Number of bytes at the start of `text` that are characters in UTF-8: all of them if the text is valid.
size_t utf8_prefix(std::string_view text);

/// `text` as UTF-8 that XML may hold: bytes that are no character, and characters that XML does not allow,
/// become U+FFFD. Names of files and arguments may hold any bytes; documents may not.
std::string clean_text(std::string_view text);

/// For text and attribute values of HTML, SVG and XML: the text is cleaned, and & < > " ' are replaced.
std::string escape_markup(std::string_view text);

/// A cell of a CSV table in quotes (RFC 4180).
std::string quoted_cell(std::string_view text);

/// A cell of a Markdown table: | is escaped, and a new line becomes a blank.
std::string markdown_cell(std::string_view text);

/// Writes a file by way of a temporary neighbour, so that no reader ever sees half of it.
/// @throws NotFinished with the file and the reason.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace drapeplan
