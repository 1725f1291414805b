#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "decoder/pixel_response.h"
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

/// Collects the samples of packets, which come in any order.
class SampleRows {
  public:
    /// `header` has the switches up to the packet.
    void add(const SamplePacket& packet, const StreamHeader& header);
    /// Those that were added since the last call, as an array that owns them. With the GIL.
    [[nodiscard]] pybind11::array take();

    /// Of memory.
    [[nodiscard]] std::size_t bytes() const { return rows_->capacity() * sizeof(SampleRow); }

  private:
    std::unique_ptr<std::vector<SampleRow>> rows_ = std::make_unique<std::vector<SampleRow>>();
    std::optional<PixelResponses> responses_;
    std::int64_t responses_begin_ = 0;  ///< slot from which on these hold
};

/// The slots [first, end) of range(first, end). \throws TypeError naming `argument` for another
/// object; InputError for a range of no slot, or before slot 0.
struct SlotRange {
    std::int64_t first = 0;
    std::int64_t end = 0;
};
[[nodiscard]] SlotRange slots_in(const pybind11::object& value, const char* argument);

}  // namespace stipple::python
