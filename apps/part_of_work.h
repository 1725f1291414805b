#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"

namespace stipple {

/// A share of the work: `number` of `count`, which begin at 1.
struct PartOfWork {
    std::int64_t number = 0;
    std::int64_t count = 0;  ///< 0: all in one run
};

/// `--part I/N`.
void add_part(Command& command, PartOfWork& part, const std::string& text);

/// For callbacks. \throws UsageError if `output` is no name of the folder that a part fills.
void check_part_folder(const std::string& output);

/// Files [begin, end), which are numbered from 0.
struct NumberRange {
    std::int64_t begin = 0;
    std::int64_t end = 0;
};

/// The files of a part, of `count` files in all. The parts have equal numbers, except for one.
[[nodiscard]] NumberRange range_of(const PartOfWork& part, std::int64_t count);

/// Numbers that rise, consecutive ones together.
[[nodiscard]] std::vector<NumberRange> ranges_of(const std::vector<std::int64_t>& numbers);

}  // namespace stipple
