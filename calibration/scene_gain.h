#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/chip_calibration.h"
#include "core/progress.h"
#include "decoder/decode_options.h"
#include "decoder/pixel_response.h"
#include "stream/sample_packet.h"
#include "stream/stream_header.h"
#include "stream/stream_reader.h"

namespace stipple {

/// Sums of a regression through the origin of the samples y of a site on the light p, with weights.
struct SceneSums {
    int samples = 0;
    double light_sample = 0;  ///< sum w p y
    double light2 = 0;        ///< sum w p^2
    double sample2 = 0;       ///< sum w y^2
};

/// Gains of the sites of a chip from a recording of any scene, without flats: each site's samples y
/// are regressed on the light p that was decoded for their exposures (docs/calibration.md):
///
///     a = sum w p y / sum w p^2,   w = 1 / (noise of p + (0.1 p)^2)
///
/// Each gain is shrunk to the mean of its neighbourhood by the variance of its estimate. Slots are
/// added in their order: the frame, then the samples that are read at its end.
class SceneGain {
  public:
    /// `header` must outlive this. \throws InputError at `where` for weighted exposures.
    SceneGain(const StreamHeader& header, const std::string& where);

    /// The decoded frame of the next slot. Precondition: frame.size() is that of `decoded_shape`.
    void add_frame(std::span<const float> frame);

    /// Samples that are read at the end of the slot whose frame was added last.
    void add_samples(const SamplePacket& packet);

    /// `prnu` is the standard deviation of the gains. What the scene does not show keeps gain 1.
    /// Variances of gains are 0: the error of a gain is no noise that the decoder could filter.
    /// Offset, dark current and noise are those of the header.
    /// Precondition: prnu > 0.
    [[nodiscard]] ChipCalibration estimate(double prnu) const;

  private:
    [[nodiscard]] float light_of(std::int64_t last_slot, std::uint64_t open_slots, int span_slots,
                                 std::size_t voxel) const;
    void add_sample(std::size_t site, const PixelResponse& response, std::uint16_t dn,
                    int light_slots, double light);

    const StreamHeader& header_;
    SiteResponses responses_;
    FrameShape frame_shape_;
    std::int64_t slots_ = 0;                  ///< frames added
    std::vector<std::vector<float>> frames_;  ///< the last ones, by slot modulo their number
    std::vector<SceneSums> sums_;             ///< of each site
};

/// Decodes a stream and estimates the gains of its chip from it, as SceneGain. \returns nothing if
/// `progress`, in slots, has stopped it. \throws InputError as StreamReader, `decode` and
/// SceneGain. Preconditions: two readers of one stream, of which nothing has been read; prnu > 0.
[[nodiscard]] std::optional<ChipCalibration> scene_calibration(
    StreamReader& decoded, StreamReader& samples, const DecodeOptions& options, double prnu,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
