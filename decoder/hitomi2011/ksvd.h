#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "decoder/hitomi2011/patch_dictionary.h"

namespace stipple {

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
