#include "core/footage_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>

#include "core/error.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// Takes the run of digits, or the single other character, that `text` begins with.
std::string_view take_piece(std::string_view& text) {
    const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
    const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(end - text.begin()));
    const auto piece = text.substr(0, length);
    text.remove_prefix(length);
    return piece;
}

std::string_view without_leading_zeros(std::string_view digits) {
    const auto first = digits.find_first_not_of('0');
    return first == std::string_view::npos ? "" : digits.substr(first);
}

std::vector<fs::path> list_folder(const fs::path& folder) {
    std::vector<fs::path> entries;
    try {
        for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
    } catch (const fs::filesystem_error& e) {
        throw InputError(folder.string(), "cannot be listed: " + e.code().message());
    }
    return entries;
}

/// A file name with one %d or %0Nd.
struct Pattern {
    std::string before;
    std::string after;
    std::size_t digits = 1;  ///< numbers are padded with zeros to this width

    explicit Pattern(const fs::path& path);
    /// The number in `name`, or -1 if it is not what printf would have written.
    [[nodiscard]] std::int64_t number_of(std::string_view name) const;
    [[nodiscard]] std::string name_of(std::int64_t number) const {
        return fmt::format("{}{:0{}}{}", before, number, digits, after);
    }
};

Pattern::Pattern(const fs::path& path) {
    const std::string name = path.filename().string();
    const auto percent = name.find('%');
    const auto letter = std::min(name.find_first_not_of("0123456789", percent + 1), name.size());
    const std::string width = name.substr(percent + 1, letter - percent - 1);
    const bool width_is_good =
        width.empty() || (width.size() == 2 && width[0] == '0' && width[1] != '0');
    if (letter == name.size() || name[letter] != 'd' || !width_is_good ||
        name.find('%', letter) != std::string::npos)
        throw InputError(path.string(),
                         "a pattern needs one %d or %0Nd (N = 1..9) in its file "
                         "name, such as frame_%04d.png");
    before = name.substr(0, percent);
    after = name.substr(letter + 1);
    if (!width.empty()) digits = static_cast<std::size_t>(width[1] - '0');
}

std::int64_t Pattern::number_of(std::string_view name) const {
    if (!name.starts_with(before) || !name.ends_with(after)) return -1;
    if (name.size() <= before.size() + after.size()) return -1;
    const char* begin = name.data() + before.size();
    const char* end = name.data() + name.size() - after.size();
    std::int64_t number = -1;
    const auto [last, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || last != end || number < 0) return -1;
    return name_of(number) == name ? number : -1;
}

}  // namespace

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

ImageFormat image_format(const fs::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png") return ImageFormat::kPng;
    if (extension == ".tif" || extension == ".tiff") return ImageFormat::kTiff;
    return extension == ".exr" ? ImageFormat::kExr : ImageFormat::kNone;
}

bool numerically_before(std::string_view a, std::string_view b) {
    const auto whole_a = a;
    const auto whole_b = b;
    while (!a.empty() && !b.empty()) {
        auto piece_a = take_piece(a);
        auto piece_b = take_piece(b);
        if (is_digit(piece_a[0]) && is_digit(piece_b[0])) {
            piece_a = without_leading_zeros(piece_a);
            piece_b = without_leading_zeros(piece_b);
            if (piece_a.size() != piece_b.size()) return piece_a.size() < piece_b.size();
        }
        if (piece_a != piece_b) return piece_a < piece_b;
    }
    if (a.empty() != b.empty()) return a.empty();
    return whole_a < whole_b;  // differ in leading zeros only
}

std::vector<fs::path> images_in_folder(const fs::path& folder) {
    auto files = list_folder(folder);
    std::erase_if(files, [](const fs::path& file) {
        return file.filename().string().starts_with('.') ||
               image_format(file) == ImageFormat::kNone;
    });
    if (files.empty()) throw InputError(folder.string(), "holds no PNG, TIFF or EXR pictures");
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return numerically_before(a.filename().string(), b.filename().string());
    });
    for (const fs::path& file : files)
        if (image_format(file) != image_format(files.front()))
            throw InputError(
                folder.string(),
                fmt::format("mixes formats: \"{}\" and \"{}\"; keep one",
                            files.front().filename().string(), file.filename().string()));
    return files;
}

std::vector<fs::path> images_of_pattern(const fs::path& pattern) {
    const Pattern names(pattern);
    if (image_format(pattern) == ImageFormat::kNone)
        throw InputError(pattern.string(), "a pattern stands for PNG, TIFF or EXR pictures");
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    std::map<std::int64_t, fs::path> found;
    for (const fs::path& file : list_folder(folder)) {
        const std::int64_t number = names.number_of(file.filename().string());
        if (number >= 0) found.emplace(number, file);
    }
    if (found.empty()) throw InputError(pattern.string(), "no file matches this pattern");
    std::vector<fs::path> files;
    for (std::int64_t next = found.begin()->first; const auto& [number, file] : found) {
        if (number != next++)
            throw InputError((folder / names.name_of(next - 1)).string(),
                             "is missing from the sequence");
        files.push_back(file);
    }
    return files;
}

}  // namespace stipple
