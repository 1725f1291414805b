#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "capture/frame_record.h"
#include "core/geometry.h"
#include "io/pixel_format.h"

namespace stipple {

/// The samples of a frame by row, column and plane; `samples` is resized. What `payload` is too
/// short for is 0.
void unpack_frame(const FrameLayout& layout, std::span<const std::uint8_t> payload,
                  std::vector<std::uint16_t>& samples);

/// Turns captured frames into frames of light: light = max(0, DN - black level) / (full scale -
/// black level), full scale 2^significant_bits - 1. Frames of a colour filter array stay mosaics of
/// one plane.
class FrameLight {
  public:
    /// \throws InputError unless 0 <= black_level_dn < full scale.
    FrameLight(const FrameLayout& layout, double black_level_dn);

    [[nodiscard]] FrameShape shape() const { return shape_; }
    /// Colour filter array of the mosaic.
    [[nodiscard]] ColourFilter filter() const { return layout_.format->filter; }
    /// Fills `light`, order (plane, row, col). Missing bytes at the end of the payload are black.
    /// Precondition: light.size() == shape().sites().
    void convert(std::span<const std::uint8_t> payload, std::span<float> light);

  private:
    FrameLayout layout_;
    FrameShape shape_;
    std::vector<float> light_of_dn_;  ///< for all values of a sample
    std::vector<std::uint16_t> samples_;
};

/// Fraction of the light of a frame that a pixel format clips, as a warning; empty if it clips
/// none. Light 1.0 is its full scale. `name` is that of the footage.
[[nodiscard]] std::string clipping_text(const std::string& name, std::span<const float> light,
                                        const PixelFormat& format);

}  // namespace stipple
