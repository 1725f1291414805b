#include "io/footage_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "io/image_file.h"

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

/// Of a folder without images: what is in it that others can read.
std::string remedy_in(const fs::path& folder) {
    for (const fs::path& file : list_folder(folder)) {
        if (std::string remedy = conversion_of(file); !remedy.empty()) return remedy;
        if (lower_extension(file) == ".stipple")
            return fmt::format("; name one of its sample streams, as {}", file.string());
    }
    return {};
}

/// Two names that differ in one number alone.
struct Step {
    std::size_t begin = 0;   ///< of the number
    std::size_t digits = 0;  ///< of the first one
    std::int64_t from = 0;
    std::int64_t to = 0;
    std::string_view after;  ///< the number
};

std::optional<Step> step_between(std::string_view before, std::string_view name) {
    auto begin = static_cast<std::size_t>(std::ranges::mismatch(before, name).in1 - before.begin());
    while (begin > 0 && is_digit(name[begin - 1])) --begin;
    const auto end_of_digits = [begin](std::string_view text) {
        const auto end = text.find_first_not_of("0123456789", begin);
        return end == std::string_view::npos ? text.size() : end;
    };
    const std::size_t end = end_of_digits(name);
    const std::size_t end_before = end_of_digits(before);
    if (name.substr(end) != before.substr(end_before)) return {};
    const auto from = parsed_number<std::int64_t>(before.substr(begin, end_before - begin));
    const auto to = parsed_number<std::int64_t>(name.substr(begin, end - begin));
    if (!from || !to) return {};
    return Step{begin, end_before - begin, *from, *to, name.substr(end)};
}

/// Tells of numbers that are missing among names of which at least half follow the one before.
/// Else the numbers may be times, or every second image was meant.
std::string missing_numbers(const fs::path& folder, const std::vector<fs::path>& files) {
    std::int64_t missing = 0;
    std::size_t follow = 0;
    std::string first;
    for (std::size_t i = 1; i < files.size(); ++i) {
        constexpr std::int64_t kMaxStep = 1'000'000;
        const std::string before = files[i - 1].filename().string();
        const std::string name = files[i].filename().string();
        const auto step = step_between(before, name);
        if (!step || step->to <= step->from || step->to - step->from > kMaxStep) continue;
        if (step->to == step->from + 1) ++follow;
        missing += step->to - step->from - 1;
        if (first.empty() && missing > 0)
            first = fmt::format("{}{:0{}}{}", name.substr(0, step->begin), step->from + 1,
                                step->digits, step->after);
    }
    if (missing == 0 || 2 * follow < files.size() - 1) return {};
    if (missing == 1)
        return fmt::format("{} is missing: the frames after it move one slot forward",
                           (folder / first).string());
    return fmt::format(
        "{} and {} more are missing: the frames after them move forward, {} slots in all",
        (folder / first).string(), missing - 1, missing);
}

/// A file name with one %d or %0Nd.
struct Pattern {
    std::string before;
    std::string after;
    std::size_t digits = 1;  ///< numbers are padded with zeros to this width

    explicit Pattern(const fs::path& path);
    /// The number in `name`, if it is one of digits between `before` and `after`.
    [[nodiscard]] std::optional<std::int64_t> number_of(std::string_view name) const;
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

std::optional<std::int64_t> Pattern::number_of(std::string_view name) const {
    if (name.size() <= before.size() + after.size()) return {};
    if (!name.starts_with(before) || !name.ends_with(after)) return {};
    name.remove_prefix(before.size());
    name.remove_suffix(after.size());
    return is_digit(name.front()) ? parsed_number<std::int64_t>(name) : std::nullopt;
}

}  // namespace

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return extension;
}

std::string conversion_of(const fs::path& file) {
    const std::string extension = lower_extension(file);
    if (extension != ".jpg" && extension != ".jpeg" && extension != ".bmp" && extension != ".webp")
        return {};
    return fmt::format("; {0} is not read, convert it: ffmpeg -i %04d{0} %04d.png", extension);
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

ImageFiles images_in_folder(const fs::path& folder) {
    auto files = list_folder(folder);
    std::erase_if(files, [](const fs::path& file) {
        return file.filename().string().starts_with('.') || image_reader(file) == nullptr;
    });
    if (files.empty())
        throw InputError(folder.string(), fmt::format("holds no {} images{}", image_format_names(),
                                                      remedy_in(folder)));
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return numerically_before(a.filename().string(), b.filename().string());
    });
    for (const fs::path& file : files)
        if (image_reader(file) != image_reader(files.front()))
            throw InputError(
                folder.string(),
                fmt::format("mixes formats: \"{}\" and \"{}\"; keep one",
                            files.front().filename().string(), file.filename().string()));
    std::string warning = missing_numbers(folder, files);
    return {std::move(files), std::move(warning)};
}

ImageFiles images_of_pattern(const fs::path& pattern) {
    const Pattern names(pattern);
    if (image_reader(pattern) == nullptr)
        throw InputError(pattern.string(),
                         fmt::format("a pattern stands for {} images{}", image_format_names(),
                                     conversion_of(pattern)));
    const fs::path folder = pattern.has_parent_path() ? pattern.parent_path() : fs::path(".");
    std::map<std::int64_t, fs::path> found;
    std::vector<std::string> left_out;
    for (const fs::path& file : list_folder(folder)) {
        const std::string name = file.filename().string();
        const auto number = names.number_of(name);
        if (!number) continue;
        if (names.name_of(*number) == name)
            found.emplace(*number, file);
        else
            left_out.push_back(name);
    }
    if (found.empty()) throw InputError(pattern.string(), "no file matches this pattern");
    ImageFiles images;
    for (std::int64_t next = found.begin()->first; const auto& [number, file] : found) {
        if (number != next++)
            throw InputError((folder / names.name_of(next - 1)).string(),
                             "is missing from the sequence");
        images.files.push_back(file);
    }
    if (!left_out.empty())
        images.warning = fmt::format(
            "{}: takes {} to {}; left out {} of other digits: {}", pattern.string(),
            images.files.front().filename().string(), images.files.back().filename().string(),
            left_out.size() == 1 ? "is 1 image" : fmt::format("are {} images", left_out.size()),
            *std::ranges::min_element(left_out, numerically_before));
    return images;
}

}  // namespace stipple
