#include "apps/part_of_work.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "core/text.h"

namespace stipple {
namespace {

/// \throws UsageError.
Shard parsed_part(const std::string& text) {
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

void add_part(Command& command, Shard& part, const std::string& text) {
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

}  // namespace stipple
