#pragma once

#include <cstdint>

#include "core/geometry.h"

namespace stipple {

class KeyReader;

/// How a chip names the columns of a row that it reads (docs/readout_timing.md).
struct ColumnAddressing {
    enum class Kind : std::uint8_t {
        kSkipChannel,  ///< each channel steps only through those of its columns that are due
        kGroup         ///< a group is transferred whole if any of its pixels is due
    };
    static constexpr int kMaxChannels = 4096;
    static constexpr int kMaxSide = kMaxFrameSide;  ///< of a group, in pixels

    Kind kind = Kind::kSkipChannel;
    int channels = 1;    ///< outputs that work in parallel; column c belongs to c mod channels
    int group_cols = 1;  ///< kGroup: neighbouring columns of a group
    int group_rows = 1;  ///< kGroup: neighbouring rows of a group

    bool operator==(const ColumnAddressing&) const = default;
};

/// The keys of an addressing, in a sensor's timing and in a schedule that is made for it.
/// \throws InputError as Config.
void read_addressing(const KeyReader& read, ColumnAddressing& addressing);

}  // namespace stipple
