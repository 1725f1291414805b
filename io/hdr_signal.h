#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "io/frame_coding.h"

namespace stipple {

/// Converts linear light to the signals of HDR video, ITU-R BT.2100. Grey is white of D65; R, G and
/// B have the primaries of BT.709 and get those of BT.2020.
///
/// PQ is the luminance on the display: light x cd_per_unit, clipped to peak_cd. HLG is the light
/// before the camera, scaled such that the reference display of 1000 cd/m2 shows light 1.0 with
/// cd_per_unit. NaN and negative light are black.
///
/// Not modelled: the rendering intent (OOTF) of PQ, so that luminance stays proportional to light.
class HdrSignal {
  public:
    /// Precondition: coding.curve is kPq or kHlg.
    HdrSignal(FrameShape shape, const VideoCoding& coding);

    /// `frame` in order (plane, row, col). `pixels` gets R'G'B' or grey, interleaved, 65535 = 1.
    /// Precondition: both hold shape.sites() values.
    void convert(std::span<const float> frame, std::span<std::uint16_t> pixels);
    /// Of all frames so far. `max_cll` and `max_fall` are of PQ.
    [[nodiscard]] LightLevels levels() const;

  private:
    struct RowSums {
        float max = 0;
        double sum = 0;  ///< of the largest of R, G and B
        int clipped = 0;
    };
    [[nodiscard]] RowSums convert_row(int row, std::span<std::uint16_t> pixels);

    FrameShape shape_;
    VideoCurve curve_;
    float scale_;  ///< to cd/m2 or to the light of HLG
    float peak_;   ///< likewise
    std::vector<float> light_;
    std::vector<RowSums> rows_;
    double max_ = 0;
    double max_mean_ = 0;
    double clipped_ = 0;
    double values_ = 0;
};

}  // namespace stipple
