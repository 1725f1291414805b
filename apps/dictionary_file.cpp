#include "apps/dictionary_file.h"

#include "decoder/decode_options.h"
#include "io/npy_volume.h"

namespace stipple {

void read_dictionary(DecodeOptions& options) {
    const std::string& file = options.hitomi2011.dictionary_file;
    if (file.empty()) return;
    const NpyVolume volume = read_npy_volume(file);
    options.hitomi2011.dictionary =
        patch_dictionary({volume.layers, volume.rows, volume.cols}, volume.values, file);
}

}  // namespace stipple
