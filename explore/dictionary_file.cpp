#include "explore/dictionary_file.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "decoder/decode_options.h"
#include "io/npy_volume.h"

namespace stipple {

void read_dictionary(DecodeOptions& options) {
    const std::string& file = options.hitomi2011.dictionary_file;
    if (file.empty()) return;
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw InputError(
            file, "there is no such dictionary of patches; \"stipple dictionary\" makes one");
    const NpyVolume volume = read_npy_volume(file);
    options.hitomi2011.dictionary =
        patch_dictionary({volume.layers, volume.rows, volume.cols}, volume.values, file);
}

}  // namespace stipple
