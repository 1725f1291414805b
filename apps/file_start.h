#pragma once

#include <string>

namespace stipple {

/// What a file that nothing knows seems to be, by its first bytes: "an empty file", "a web page
/// (HTML)", `text that begins "..."`, "a file that begins with the bytes 89 41 42".
/// \throws InputError if the file cannot be read.
[[nodiscard]] std::string sniff_file_type(const std::string& file);

}  // namespace stipple
