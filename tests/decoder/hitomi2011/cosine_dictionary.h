#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "decoder/hitomi2011/patch_dictionary.h"

namespace stipple {

/// Products of cosines of slot, row and column, with frequencies of sum 0..max_sum: the low
/// frequencies of a discrete cosine transform, which is orthonormal. Atom 0 is constant.
inline PatchDictionary cosine_dictionary(AtomShape shape, int max_sum) {
    const auto cosine = [](int frequency, int i, int length) {
        return std::cos(std::numbers::pi * frequency * (2 * i + 1) / (2.0 * length));
    };
    std::vector<double> values;
    int atoms = 0;
    for (int sum = 0; sum <= max_sum; ++sum)
        for (int f = 0; f <= sum; ++f)
            for (int g = 0; g + f <= sum; ++g) {
                const int h = sum - f - g;
                if (f >= shape.slots || g >= shape.side_px || h >= shape.side_px) continue;
                ++atoms;
                for (int slot = 0; slot < shape.slots; ++slot)
                    for (int row = 0; row < shape.side_px; ++row)
                        for (int col = 0; col < shape.side_px; ++col)
                            values.push_back(cosine(f, slot, shape.slots) *
                                             cosine(g, row, shape.side_px) *
                                             cosine(h, col, shape.side_px));
            }
    return patch_dictionary({atoms, shape.slots, shape.side_px * shape.side_px}, values, "cosines");
}

}  // namespace stipple
