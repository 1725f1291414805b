#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

enum class ImageFormat { kNone, kPng, kTiff, kExr, kDng };

/// Format of a picture by its extension, in upper or lower case.
[[nodiscard]] ImageFormat image_format(const std::filesystem::path& file);

/// The extension in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

/// True if `a` comes before `b` when runs of digits compare as numbers: "f9" before "f10".
[[nodiscard]] bool numerically_before(std::string_view a, std::string_view b);

/// Pictures in the order of their numbers.
struct ImageFiles {
    std::vector<std::filesystem::path> files;
    std::string warning;  ///< of numbers that are missing or left out; empty if there are none
};

/// The pictures of a folder in numeric order of names. Hidden files and files of other kinds
/// (meta.json) are left out.
/// \throws InputError if there are none, if formats are mixed, or if the folder is unreadable.
[[nodiscard]] ImageFiles images_in_folder(const std::filesystem::path& folder);

/// The pictures that a printf pattern with one %d or %0Nd in its file name stands for, in order,
/// from the smallest number there is to the largest.
/// \throws InputError if the pattern is malformed, nothing matches, or a number is missing.
[[nodiscard]] ImageFiles images_of_pattern(const std::filesystem::path& pattern);

}  // namespace stipple
