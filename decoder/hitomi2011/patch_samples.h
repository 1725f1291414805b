#pragma once

#include <cstddef>
#include <vector>

#include "decoder/hitomi2011/matching_pursuit.h"
#include "decoder/hitomi2011/patch_dictionary.h"
#include "decoder/portz2013/exposure_table.h"

namespace stipple {

struct Measurements;

/// The first voxel of a patch, in a block; parts of the patch may lie outside.
struct AtomPosition {
    int slot = 0;
    int plane = 0;
    int row = 0;
    int col = 0;
};

struct CodingLimits {
    int max_atoms = 0;
    double noise_factor = 0;  ///< the pursuit ends at the noise of the samples times this
};

/// Samples of a block by patches, and their codes by a dictionary.
class PatchSamples {
  public:
    /// Both must outlive this.
    PatchSamples(const Measurements& measurements, const PatchDictionary& dictionary);

    /// The number of exposures of all sites that lie in patches that begin in each slot of the
    /// block; a patch may end after the block.
    [[nodiscard]] std::vector<std::size_t> exposures_by_first_slot() const;

    /// The sparse sum of atoms that explains the samples whose whole exposures are in the patch,
    /// each divided by the norm of its weights. Saturated samples take part only if the sum would
    /// be below them. Empty without samples.
    [[nodiscard]] SparseCode code(const AtomPosition& at, const CodingLimits& limits) const;

  private:
    class SampledAtoms;
    [[nodiscard]] SampledAtoms sampled_atoms(const AtomPosition& at) const;

    const Measurements& measurements_;
    const PatchDictionary& dictionary_;
    ExposureTable table_;
    std::vector<float> by_voxel_;  ///< the dictionary
};

}  // namespace stipple
