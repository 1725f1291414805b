#include "decoder/hitomi2011/patch_dictionary.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/exposure_schedule.h"

namespace stipple {
namespace {

/// The side of a square of so many pixels; 0 if there is none.
int side_of(int pixels) {
    int side = 0;
    while (side * side < pixels) ++side;
    return side * side == pixels ? side : 0;
}

}  // namespace

std::vector<float> PatchDictionary::by_voxel() const {
    std::vector<float> sorted(values.size());
    for (int number = 0; number < atoms; ++number)
        for (std::size_t voxel = 0; voxel < shape.voxels(); ++voxel)
            sorted[voxel * index(atoms) + index(number)] = atom(number)[voxel];
    return sorted;
}

PatchDictionary patch_dictionary(const ArrayShape& shape, std::span<const double> values,
                                 std::string_view where) {
    const int side = side_of(shape.cols);
    if (side == 0 || shape.rows > kMaxExposureSlots)
        throw InputError(
            where,
            fmt::format("{} x {} x {} values are not a dictionary (atom, slot, pixel) of square "
                        "patches of 1..{} slots; make one with \"stipple dictionary\"",
                        shape.layers, shape.rows, shape.cols, kMaxExposureSlots));
    PatchDictionary result{.shape = AtomShape{.slots = shape.rows, .side_px = side},
                           .atoms = shape.layers,
                           .values = std::vector<float>(values.size())};
    const std::size_t voxels = result.shape.voxels();
    for (int number = 0; number < shape.layers; ++number) {
        const auto atom = values.subspan(index(number) * voxels, voxels);
        double most = 0;
        for (const double value : atom) {
            if (!std::isfinite(value))
                throw InputError(
                    where,
                    fmt::format("atom {} holds {}, which is not a finite number", number, value));
            most = std::max(most, std::abs(value));
        }
        double square = 0;
        for (const double value : atom) square += most > 0 ? value / most * (value / most) : 0;
        if (square == 0)
            throw InputError(where, fmt::format("atom {} is 0 everywhere; leave it out", number));
        const double norm = std::sqrt(square);
        for (std::size_t i = 0; i < voxels; ++i)
            result.values[index(number) * voxels + i] = static_cast<float>(atom[i] / most / norm);
    }
    return result;
}

}  // namespace stipple
