#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <span>
#include <string>

#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple::python {

/// A row of the array of samples.
struct SampleRow {
    std::int64_t slot;
    std::uint16_t row, col;
    std::uint8_t plane, exposure_slots, light_slots;
    bool saturated;
    std::uint64_t open_slots;
    std::uint16_t dn;
    std::uint16_t zero[3];  ///< no field, but the same bytes for the same samples
};

/// The samples of packets as an array of SampleRow, with the GIL. `header` has the switches up to
/// the last of them. \throws InputError at `name` as check_memory.
[[nodiscard]] pybind11::array sample_rows(const StreamHeader& header,
                                          std::span<const SamplePacket> packets,
                                          const std::string& name);

/// The slots [first, end) of range(first, end). \throws TypeError naming `argument` for another
/// object; InputError for a range of no slot, or before slot 0.
struct StreamSlots {
    std::int64_t first = 0;
    std::int64_t end = 0;
};
[[nodiscard]] StreamSlots slots_in(const pybind11::object& value, const char* argument);

}  // namespace stipple::python
