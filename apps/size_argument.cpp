#include "apps/size_argument.h"

#include <fmt/format.h>

#include <charconv>

#include "apps/command_line.h"

namespace stipple {

void parse_size(const std::string& option, const std::string& text, int least, int most,
                FrameShape& shape) {
    const char* const end = text.data() + text.size();
    const auto cols = std::from_chars(text.data(), end, shape.cols);
    const bool crossed = cols.ptr != end && *cols.ptr == 'x';
    const auto rows = std::from_chars(crossed ? cols.ptr + 1 : end, end, shape.rows);
    if (cols.ec != std::errc() || rows.ec != std::errc() || rows.ptr != end)
        throw UsageError(option, "\"" + text + "\" is not a size like 640x480");
    for (const int side : {shape.cols, shape.rows})
        if (side < least || side > most)
            throw UsageError(option,
                             fmt::format("{}: sides are {} to {} pixels", text, least, most));
}

}  // namespace stipple
