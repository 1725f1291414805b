#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "decoder/decode_method.h"
#include "decoder/measurements.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"

namespace stipple {

/// One decoded frame of a stream that is being written.
struct PreviewFrame {
    std::int64_t slot = 0;
    FrameShape shape;
    std::vector<float> light;     ///< order (plane, row, col), units of FluxVideo
    std::vector<bool> saturated;  ///< by pixel: all samples of a colour are saturated
    [[nodiscard]] double saturated_fraction() const;
    [[nodiscard]] double mean_light() const;
};

struct PreviewOptions {
    DecodeMethod method = DecodeMethod::kNaive;  ///< or kFast
    std::optional<FrameShape> size;              ///< rows and columns of the middle of the frame
};

/// Decodes single frames of a stream, from the minimum number of slots that contain the exposures
/// around them. The number of voxels is limited, so that a frame takes at most some seconds and
/// some hundred MB: of a frame that is too large only the middle is decoded.
class PreviewDecoder {
  public:
    PreviewDecoder(StreamHeader header, const PreviewOptions& options);

    /// Number of slots that a frame is decoded from.
    [[nodiscard]] int slots() const { return region_.slots; }
    /// Which of these slots is shown.
    [[nodiscard]] int shown_slot() const { return region_.slots / 2; }
    [[nodiscard]] FrameShape shape() const { return region_.shape; }

    /// Decodes the packets of the slots() slots from `first_slot`, to the frame of slot `shown` of
    /// these (none: shown_slot()). Returns nothing if `progress` has stopped it. \throws InputError
    /// as collect_measurements.
    [[nodiscard]] std::optional<PreviewFrame> decode(std::int64_t first_slot,
                                                     std::span<const SamplePacket> packets,
                                                     const ProgressCallback& progress,
                                                     std::optional<int> shown = {}) const;

  private:
    StreamHeader header_;
    DecodeMethod method_;
    VideoWindow region_;  ///< of the first slots
};

}  // namespace stipple
