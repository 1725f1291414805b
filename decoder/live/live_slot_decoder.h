#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "decoder/live/window_decoder.h"
#include "decoder/measurements.h"

namespace stipple {

/// Slots from which every pixel has a sample, wherever they begin; 0 without exposures.
[[nodiscard]] int slots_with_a_sample(const ExposureSchedule& schedule);

/// Decodes single slots by the method `live`, each from the samples of its window alone, in bands
/// of rows: in 20 MB for each thread (of 640 columns and one plane) that are kept for the next one.
class LiveSlotDecoder {
  public:
    struct Frame {
        FluxVideo light;                  ///< one slot; not negative
        std::vector<std::uint8_t> known;  ///< by site, as of average_in_time
    };
    /// Slot `slot` of a window: `live` counts the slots of `window`, and has all of them. The bits
    /// are those of `decode_live` if each site that has samples in the block has some in the
    /// window; other sites are interpolated from their surroundings. \throws InputError as
    /// collect_measurements.
    [[nodiscard]] Frame decode(const StreamHeader& header, std::span<const SamplePacket> packets,
                               const VideoWindow& window, const LiveWindow& live, int slot);

  private:
    struct Memory {
        Measurements measurements;
        WindowDecoder decoder;
        std::vector<float> light;
        std::vector<std::uint8_t> known;
    };
    std::vector<Memory> memory_;  ///< one for each thread
};

}  // namespace stipple
