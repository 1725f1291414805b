#pragma once

#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/plane.h"

namespace stipple {

/// Photon flux at every site in each slot: the linear light that is the input of the sensor and the
/// output of the decoder. Unit: 1.0 = `photons_per_unit` (r of Eq. 1) photons per site and slot;
/// >= 0. Contiguous, order (slot, plane, row, col).
class FluxVideo {
  public:
    FluxVideo() = default;
    FluxVideo(int slots, FrameShape shape)
        : slots_(slots), shape_(shape), flux_(static_cast<std::size_t>(slots) * shape.sites()) {}

    [[nodiscard]] int slots() const { return slots_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] std::size_t voxels() const { return flux_.size(); }

    [[nodiscard]] std::span<float> data() { return flux_; }
    [[nodiscard]] std::span<const float> data() const { return flux_; }

    /// All planes of one slot, order (plane, row, col). Precondition: 0 <= slot < slots().
    [[nodiscard]] std::span<float> frame(int slot) { return data().subspan(at(slot, 0), sites()); }
    [[nodiscard]] std::span<const float> frame(int slot) const {
        return data().subspan(at(slot, 0), sites());
    }

    /// One plane of one slot. Precondition: 0 <= slot < slots(), 0 <= plane < shape().planes.
    [[nodiscard]] PlaneView<float> plane(int slot, int plane) {
        return {flux_.data() + at(slot, plane), shape_.rows, shape_.cols};
    }
    [[nodiscard]] PlaneView<const float> plane(int slot, int plane) const {
        return {flux_.data() + at(slot, plane), shape_.rows, shape_.cols};
    }

  private:
    [[nodiscard]] std::size_t sites() const { return shape_.sites(); }
    [[nodiscard]] std::size_t at(int slot, int plane) const {
        assert(slot >= 0 && slot < slots_ && plane >= 0 && plane < shape_.planes);
        return static_cast<std::size_t>(slot) * shape_.sites() +
               static_cast<std::size_t>(plane) * shape_.pixels();
    }

    int slots_ = 0;
    FrameShape shape_;
    std::vector<float> flux_;
};

}  // namespace stipple
