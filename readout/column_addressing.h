#pragma once

#include <cstdint>

#include "core/geometry.h"

namespace stipple {

class KeyReader;

/// Selection of the columns that a chip transfers of a row (docs/readout_timing.md).
struct ColumnAddressing {
    enum class Kind : std::uint8_t {
        kSkipChannel,  ///< each channel transfers its due columns only
        kGroup         ///< each group with a due pixel is transferred whole
    };
    static constexpr int kMaxChannels = 4096;
    static constexpr int kMaxSide = kMaxFrameSide;  ///< of a group, in pixels

    Kind kind = Kind::kSkipChannel;
    int channels = 1;    ///< parallel outputs, 1..4096; column c belongs to channel c mod channels
    int group_cols = 1;  ///< kGroup: width of a group in pixels, 1..65535
    int group_rows = 1;  ///< kGroup: height of a group in pixels, 1..65535

    bool operator==(const ColumnAddressing&) const = default;
};

/// Reads the keys `addressing`, `channels`, `group_cols` and `group_rows` into `addressing`; an
/// absent key leaves its member. They are in the section [timing] of sensors and in schedules of
/// kind "hardware_tiled". \throws InputError as Config.
void read_addressing(const KeyReader& read, ColumnAddressing& addressing);

}  // namespace stipple
