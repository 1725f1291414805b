#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// What to do with a common kind of image that is not read, as the end of a message; else empty.
[[nodiscard]] std::string conversion_of(const std::filesystem::path& file);

/// The extension in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

/// True if `a` comes before `b` when runs of digits compare as numbers: "f9" before "f10".
[[nodiscard]] bool numerically_before(std::string_view a, std::string_view b);

/// Images in the order of their numbers.
struct ImageFiles {
    std::vector<std::filesystem::path> files;
    std::string warning;  ///< about missing or omitted numbers; empty if there are none
};

/// The images of a folder in numeric order of names. Hidden files and files of other kinds
/// (meta.json) are omitted.
/// \throws InputError if there are none, if formats are mixed, or if the folder is unreadable.
[[nodiscard]] ImageFiles images_in_folder(const std::filesystem::path& folder);

/// The images of a printf pattern with one %d or %0Nd in its file name, in order, from the smallest
/// existing number to the largest.
/// \throws InputError if the pattern is malformed, nothing matches, or a number is missing.
[[nodiscard]] ImageFiles images_of_pattern(const std::filesystem::path& pattern);

}  // namespace stipple
