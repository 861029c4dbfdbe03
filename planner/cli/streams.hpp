// The program's standard streams, in whatever condition it is started with.
#pragma once

#include <string>

namespace drapeplan {

/// Opens stdin, stdout and stderr on /dev/null where they are closed, so that no result file takes their
/// descriptors; and a reader that is gone becomes an error of writing instead of the program's end.
void prepare_streams();

/// Writes to stdout.
/// @param kept  whether the text is in a file, too: then a reader that is gone has missed nothing.
/// @throws NotFinished with the reason if it cannot be written.
void print(const std::string& text, bool kept);

}  // namespace drapeplan
