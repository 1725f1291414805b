#include <fmt/format.h>

#include <cstddef>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/mat_volume.h"
#include "io/npz_volume.h"
#include "readout/measured_stream.h"

namespace stipple {
namespace {

NpyVolume read_volume(const std::string& file, const std::string& variable, NpyImages images) {
    if (is_mat(file)) return read_mat_volume(file, variable);
    if (is_npz(file)) return read_npz_volume(file, variable, images);
    return read_npy_volume(file, images);
}

}  // namespace

void keep_masks(NpyVolume& masks, int slots, const std::string& file) {
    if (slots == 0) return;
    if (slots > masks.layers)
        throw InputError(file, fmt::format("has {}, fewer than ", counted(masks.layers, "mask")) +
                                   Parameter{"slots", fmt::format("{}", slots)});
    masks.values.resize(masks.values.size() / index(masks.layers) * index(slots));
    masks.layers = slots;
}

void read_measured_files(const MeasuredFiles& files, MeasuredArrays& arrays) {
    arrays.measurement_file = files.measurements;
    arrays.measurements = read_volume(files.measurements, files.variable, NpyImages::kOneLayer);
    arrays.mask_file = files.masks;
    if (files.masks.empty()) {
        if (!is_mat(files.measurements) && !is_npz(files.measurements))
            throw InputError(Parameter{"masks"},
                             "is needed; only a .npz or .mat file may hold the masks too");
        arrays.mask_file = files.measurements;
    }
    arrays.masks = read_volume(arrays.mask_file, files.mask_variable, NpyImages::kRefused);
    keep_masks(arrays.masks, files.slots, arrays.mask_file);
}

}  // namespace stipple
