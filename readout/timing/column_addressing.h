#pragma once

#include <cstdint>

namespace stipple {

/// How a chip names the columns of a row that it reads (docs/readout_timing.md).
struct ColumnAddressing {
    enum class Kind : std::uint8_t {
        kGroup,       ///< a group is transferred whole if any of its pixels is due
        kSkipChannel  ///< each channel steps only through those of its columns that are due
    };
    Kind kind = Kind::kSkipChannel;
    int channels = 1;    ///< outputs that work in parallel; column c belongs to c mod channels
    int group_cols = 1;  ///< kGroup: neighbouring columns of a group
    int group_rows = 1;  ///< kGroup: neighbouring rows of a group

    bool operator==(const ColumnAddressing&) const = default;
};

}  // namespace stipple
