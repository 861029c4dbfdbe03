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

/// What a file holds, or why it cannot be read.
struct FileText {
  std::string text;
  std::string fault;  ///< "it is a folder", "Permission denied"; empty if it could be read
};

/// Reads a whole file of at most 256 MB. Devices are refused, and so are pipes, which may never end or begin.
/// @param pipes  are read all the same: the user names the file on the command line, as in `check <(make_case)`.
FileText read_file(const std::filesystem::path& file, bool pipes = false);

/// A piece of an input as a message shows it: in UTF-8 without control characters, cut after 40 characters.
std::string shown(std::string_view text);

/// Writes a file by way of a temporary neighbour, so that no reader ever sees half of it.
/// @throws NotFinished with the file and the reason.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace drapeplan
