#pragma once

#include <cstddef>
#include <cstdint>

#include "stream/stream_header.h"

namespace stipple {

struct RowBand {
    int first_row = 0;
    int rows = 0;
};

/// True if `samples` samples are due in these rows of `slot`: planes x `count_due`, but counted by
/// tiles, and no further than `samples`, so that a false claim costs no more than a true one.
[[nodiscard]] bool matches_schedule(const StreamHeader& stream, std::int64_t slot, RowBand band,
                                    std::size_t samples);

}  // namespace stipple
