#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/index.h"

namespace stipple {

/// Size of a space-time patch: a square of pixels in successive slots.
struct AtomShape {
    int slots = 0;
    int side_px = 0;

    [[nodiscard]] std::size_t pixels() const { return index(side_px) * index(side_px); }
    [[nodiscard]] std::size_t voxels() const { return index(slots) * pixels(); }
    bool operator==(const AtomShape&) const = default;
};

/// Patches of norm 1, of which others are sparse sums.
struct PatchDictionary {
    AtomShape shape;
    int atoms = 0;
    std::vector<float> values;  ///< order (atom, slot, row, col)

    [[nodiscard]] std::span<const float> atom(int number) const {
        return std::span(values).subspan(index(number) * shape.voxels(), shape.voxels());
    }
    /// The values in the order (slot, row, col, atom).
    [[nodiscard]] std::vector<float> by_voxel() const;
};

/// An array as a file holds it: order (layer, row, col).
struct ArrayShape {
    int layers = 0;
    int rows = 0;
    int cols = 0;
};

/// The dictionary of an array (atom, slot, pixel), the pixels of a square row by row. Atoms are
/// scaled to norm 1. \throws InputError at `where` if the pixels are no square, a value is not
/// finite, an atom is 0, or a patch has more than 64 slots.
[[nodiscard]] PatchDictionary patch_dictionary(const ArrayShape& shape,
                                               std::span<const double> values,
                                               std::string_view where);

}  // namespace stipple
