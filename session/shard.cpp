#include "session/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>

#include "core/error.h"

namespace stipple {

NumberRange range_of(const Shard& shard, std::int64_t count) {
    return {count * (shard.number - 1) / shard.count, count * shard.number / shard.count};
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

std::vector<std::int64_t> NumberedFiles::missing(const NumberRange& range) const {
    std::vector<std::int64_t> numbers;
    for (std::int64_t number = range.begin; number < range.end; ++number)
        if (!holds(number)) numbers.push_back(number);
    return numbers;
}

void NumberedFiles::require_all(const std::filesystem::path& folder,
                                const ShardFolderKind& kind) const {
    constexpr std::size_t kMaxNamed = 8;
    const std::vector<std::int64_t> lacking = missing({0, count});
    if (lacking.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < std::min(lacking.size(), kMaxNamed); ++i)
        names += fmt::format("{}{}", i == 0 ? "" : ", ", file(lacking[i]).filename().string());
    if (lacking.size() > kMaxNamed)
        names += fmt::format(" and {} more", lacking.size() - kMaxNamed);
    throw InputError(folder.string(),
                     fmt::format("lacks {} of its {} {}: {}; {} again, which keeps the others",
                                 lacking.size(), count, kind.parts, names, kind.verb));
}

}  // namespace stipple
