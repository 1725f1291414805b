#pragma once

#include <cstdint>
#include <vector>

namespace stipple {

/// The samples of one slot, or of a band of its rows: for each pixel that `for_each_readout`
/// visits, row by row, one DN per plane.
struct SamplePacket {
    static constexpr std::uint8_t kOverrun = 1;  ///< the readout took longer than its slot
    static constexpr std::uint8_t kDropped = 2;  ///< the chip discarded them: `dn` is empty

    std::int64_t slot = 0;
    int first_row = 0;
    int rows = 0;
    std::uint8_t flags = 0;
    std::vector<std::uint16_t> dn;

    bool operator==(const SamplePacket&) const = default;
};

}  // namespace stipple
