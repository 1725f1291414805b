#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "decoder/hitomi2011/patch_dictionary.h"

namespace stipple {

/// Patches of footage at random places, for a dictionary to learn from: each is turned, mirrored
/// and reversed in time at random, and divided by its mean light. Patches with a contrast (standard
/// deviation over mean) below 2 % are left out. All places of all clips are equally likely. The
/// footage is read once, frame by frame.
class TrainingPatches {
  public:
    TrainingPatches(AtomShape shape, std::size_t max_patches, std::uint64_t seed);

    /// The next frames are of another clip. Precondition: rows, cols >= side_px.
    void begin_clip(FrameShape shape);
    /// Order (plane, row, col).
    void add_frame(std::span<const float> frame);

    [[nodiscard]] std::size_t patches() const { return patches_.size() / shape_.voxels(); }
    /// Order (patch, slot, row, col).
    [[nodiscard]] std::vector<float> take() { return std::move(patches_); }

  private:
    void draw_patch();

    AtomShape shape_;
    std::size_t max_patches_;
    std::uint64_t seed_;
    FrameShape frame_shape_;
    std::vector<std::vector<float>> frames_;  ///< the newest ones, the oldest first
    std::vector<float> patch_;
    std::uint64_t draws_ = 0;
    std::uint64_t seen_ = 0;  ///< patches with contrast
    std::vector<float> patches_;
};

}  // namespace stipple
