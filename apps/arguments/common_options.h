#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "core/geometry.h"

namespace stipple {

// Checks of numbers. Unlike CLI11's own they refuse NaN and whole numbers that do not fit, and say
// an open range in words.

/// Finite, and min..max.
[[nodiscard]] ValueCheck number_check(double min, double max = std::numeric_limits<double>::max());
/// Above 0, and neither 0 nor infinite as the float that light is.
[[nodiscard]] ValueCheck positive_check();
/// Without a fraction, and min..max.
[[nodiscard]] ValueCheck whole_check(std::uint64_t min,
                                     std::uint64_t max = std::numeric_limits<std::uint64_t>::max());

/// A number of frames or slots: 1 to 2^53, which JSON holds exactly.
[[nodiscard]] ValueCheck frames_check();

/// The sides that an image may have, in pixels.
struct SideRange {
    int min;
    int max;
};

/// Takes "640x480", width and height, into `shape`. \throws UsageError naming `option` if
/// it is no such text or a side is outside `sides`.
void parse_size(const std::string& option, const std::string& text, SideRange sides,
                FrameShape& shape);

/// An option WxH, which sets rows and columns of `shape`. The help ends with the present size,
/// unless that is empty.
CommandOption add_size(Command& command, const std::string& name, FrameShape& shape,
                       SideRange sides, const std::string& text);

/// The names of things that have one, for CommandOption::one_of.
template <typename Things>
[[nodiscard]] std::vector<std::string> names_of(const Things& things) {
    std::vector<std::string> names;
    for (const auto& thing : things) names.emplace_back(thing.name);
    return names;
}

/// `-o,--output`, which is required.
CommandOption add_output(Command& command, std::string& output, const std::string& text,
                         const OutputName& name = {}, const std::string& type_name = "FILE");

/// `--seed S`.
CommandOption add_seed(Command& command, std::uint64_t& seed, const std::string& text);

}  // namespace stipple
