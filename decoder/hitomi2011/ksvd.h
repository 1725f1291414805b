#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

struct KsvdOptions {
    int atoms = 512;
    int sparsity = 8;  ///< max atoms of a code
    int iterations = 12;
    std::uint64_t seed = 1;
    /// Receives the number of finished iterations and the error: the root mean square of what the
    /// codes leave of the patches. False stops.
    std::function<bool(int iterations, double error)> keep_going = [](int, double) { return true; };
};

/// K-SVD (Aharon, Elad, Bruckstein 2006): codes all patches by orthogonal matching pursuit, then
/// updates each atom and its weights to explain what the other atoms leave, in turn. The update is
/// not a singular value decomposition but two steps of alternating least squares. A patch keeps its
/// code if the new one explains less, so the error never increases. Atom 0 is constant and stays
/// so; the others begin as patches without their mean. An atom that no patch uses becomes the
/// residual of the patch with the largest. `patches` in the order (patch, slot, row, col). The same
/// bits for any thread count. Precondition: at least `atoms` patches.
[[nodiscard]] PatchDictionary learn_dictionary(std::span<const float> patches, AtomShape shape,
                                               const KsvdOptions& options);

}  // namespace stipple
