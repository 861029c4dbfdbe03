// Small helpers of the files we write: numbers, escaping, whole files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace drapeplan {

/// Shortest decimal text that reads back as the same bits.
std::string exact(double value);

/// `value` with `decimals` digits after the point, never "-0.0"; an en dash where it is not finite.
std::string fixed(double value, int decimals);

/// For text and attribute values of HTML, SVG and XML: & < > " ' are replaced, and so are control characters
/// that XML does not allow (by U+FFFD).
std::string escape_markup(std::string_view text);

/// Writes a file by way of a temporary neighbour, so that no reader ever sees half of it.
/// @throws NotFinished with the file and the reason.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace drapeplan
