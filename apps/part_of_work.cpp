#include "apps/part_of_work.h"

#include <cstddef>
#include <filesystem>

#include "core/parsed_number.h"

namespace stipple {
namespace {

/// \throws UsageError.
PartOfWork parsed_part(const std::string& text) {
    constexpr std::int64_t kMaxParts = 1'000'000;
    const std::size_t slash = text.find('/');
    const auto number = parsed_number<std::int64_t>(text.substr(0, slash));
    const auto count = parsed_number<std::int64_t>(
        slash == std::string::npos ? std::string() : text.substr(slash + 1));
    if (!number || !count || *number < 1 || *number > *count || *count > kMaxParts)
        throw UsageError("--part", "is a number and how many there are, such as 1/16 to 16/16");
    return {.number = *number, .count = *count};
}

}  // namespace

void add_part(Command& command, PartOfWork& part, const std::string& text) {
    command
        .add_parsed(
            "--part", [&part](const std::string& given) { part = parsed_part(given); }, text)
        .type_name("I/N");
}

void check_part_folder(const std::string& output) {
    const std::filesystem::path folder(output);
    if (output == "-") throw UsageError("--output", "with --part it is a folder; give it a name");
    if (folder.has_extension() && !std::filesystem::is_directory(folder))
        throw UsageError("--output", "with --part it is a folder, and has no extension");
}

NumberRange range_of(const PartOfWork& part, std::int64_t count) {
    return {count * (part.number - 1) / part.count, count * part.number / part.count};
}

std::vector<NumberRange> ranges_of(const std::vector<std::int64_t>& numbers) {
    std::vector<NumberRange> ranges;
    for (const std::int64_t number : numbers)
        if (!ranges.empty() && ranges.back().end == number)
            ++ranges.back().end;
        else
            ranges.push_back({number, number + 1});
    return ranges;
}

}  // namespace stipple
