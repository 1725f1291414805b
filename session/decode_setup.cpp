#include "session/decode_setup.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/error.h"
#include "io/npy_file.h"

namespace stipple {

DecodeSetup decode_setup(std::string_view method, Config config) {
    return {.options = read_decode_options(decode_method_from_name(method), config),
            .given = config.as_toml("")};
}

DecodeSetup read_decode_setup(std::string_view method, Config config) {
    DecodeSetup setup = decode_setup(method, std::move(config));
    read_dictionary(setup.options);
    return setup;
}

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
