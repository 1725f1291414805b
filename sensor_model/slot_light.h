#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "sensor_model/physical_terms.h"

namespace stipple {

/// Scene light to the light that arrives in each pixel in a slot, in the units of the scene
/// (docs/physics.md):
///
///     late(row) = (1 - a) frame + a (frame before),  a = row_skew_slots row / (rows - 1)
///     arriving  = (1 - c) late + c / 4 (sum of late over the four neighbours)
///
/// c is the crosstalk. A neighbour beyond the edge has the light of the pixel itself. Before the
/// first frame the light was that of the first frame.
class SlotLight {
  public:
    SlotLight(const PhysicalTerms& terms, FrameShape shape);

    /// Whether the terms change the light of a slot at all.
    [[nodiscard]] static bool changes(const PhysicalTerms& terms);

    /// The light of the next slot; valid as long as `frame`, and until the next call. The same bits
    /// for any number of threads. Precondition: frame.size() == shape.sites(), light >= 0 and not
    /// NaN.
    [[nodiscard]] std::span<const float> arriving(std::span<const float> frame);

    /// Adds to the light of this slot what overflows from the neighbours (blooming): `blooming` / 4
    /// of the overflow of each. Precondition: after `arriving`; overflow.size() == shape.sites(),
    /// finite. \returns the light of the slot, valid until the next call of `arriving`.
    [[nodiscard]] std::span<const float> with_overflow(std::span<const float> overflow);

  private:
    void delay(std::span<const float> frame);

    FrameShape shape_;
    float skew_slots_;
    float crosstalk_;
    float blooming_;
    bool first_ = true;
    std::vector<float> before_;  ///< the frame before; empty without row skew
    std::vector<float> late_;    ///< of this slot, delayed; empty without row skew
    std::vector<float> arriving_;
};

/// RGB light behind a colour filter array: each pixel of `mosaic` gets the plane of its filter.
/// `frame` has `shape`, order (plane, row, col); `mosaic` has shape.pixels() values.
/// Precondition: shape.planes == 3, filter is not kNone.
///
/// Not modelled: spectra of filters (no crosstalk of colours, no loss of light), optical low-pass.
void take_mosaic(ColourFilter filter, FrameShape shape, std::span<const float> frame,
                 std::span<float> mosaic);

}  // namespace stipple
