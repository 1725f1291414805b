#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "decoder/block_partition.h"
#include "decoder/decode_method.h"
#include "decoder/live/live_slot_decoder.h"
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
    DecodeMethod method = DecodeMethod::kNaive;  ///< or kLive, kFast
    std::optional<FrameShape> size;              ///< rows and columns of the middle of the frame
};

/// A slot of a stream, and the slots that it is decoded from: `live` decodes it in their core.
struct PreviewSlots {
    HaloRange range;
    std::int64_t shown = 0;
};

/// Decodes single frames of a stream, from the minimum number of slots that contain the exposures
/// around them; `live` from the window of its method, or by `naive` where pixels have no sample in
/// such a window. The number of voxels is limited, so that a frame takes at most some seconds and
/// some hundred MB: of a frame that is too large only the middle is decoded.
class PreviewDecoder {
  public:
    /// `header` must outlive this. It decodes the slots of all its schedules.
    PreviewDecoder(const StreamHeader& header, const PreviewOptions& options);

    /// Number of slots that a frame is decoded from, where the stream has as many.
    [[nodiscard]] int slots() const { return region_.slots; }
    [[nodiscard]] FrameShape shape() const { return region_.shape; }
    [[nodiscard]] DecodeMethod method() const { return method_; }
    /// Of the last slots() slots before `end`, the one that is shown of a growing stream.
    [[nodiscard]] PreviewSlots newest(std::int64_t end) const;
    /// What a slot is decoded from in a stream that has `slots` slots so far; by `live` as in
    /// `decode`.
    [[nodiscard]] PreviewSlots around(std::int64_t slot, std::int64_t slots) const;

    /// Decodes a slot from the packets of its slots. The method `live` has the bits of `decode` if
    /// no sample is lost, and keeps its memory. Returns nothing if `progress` has stopped it.
    /// \throws InputError as collect_measurements.
    [[nodiscard]] std::optional<PreviewFrame> decode(const PreviewSlots& slots,
                                                     std::span<const SamplePacket> packets,
                                                     const ProgressCallback& progress);

  private:
    const StreamHeader& header_;
    bool in_live_window_;  ///< by `live`
    DecodeMethod method_;
    VideoWindow region_;  ///< of the first slots
    LiveSlotDecoder live_;
};

}  // namespace stipple
