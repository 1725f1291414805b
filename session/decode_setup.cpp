#include "session/decode_setup.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/input_file.h"
#include "decoder/plug_and_play/network_denoiser.h"
#include "io/npy_file.h"

namespace stipple {

DecodeSetup decode_setup(std::string_view method, Config config) {
    return {.options = read_decode_options(decode_method_from_name(method), config),
            .given = config.as_toml("")};
}

DecodeSetup read_decode_setup(std::string_view method, Config config) {
    DecodeSetup setup = decode_setup(method, std::move(config));
    read_option_file(setup.options);
    return setup;
}

std::string option_file(const DecodeOptions& options) {
    switch (options.method) {
        case DecodeMethod::kHitomi2011:
            return options.hitomi2011.dictionary_file;
        case DecodeMethod::kPlugAndPlay:
            return options.plug_and_play.network_file;
        default:
            return {};
    }
}

void read_option_file(DecodeOptions& options) {
    const std::string file = option_file(options);
    if (file.empty()) return;
    const bool network = options.method == DecodeMethod::kPlugAndPlay;
    std::error_code error;
    if (!std::filesystem::exists(file, error))
        throw InputError(
            file, network ? "there is no such network"
                          : "there is no such dictionary of patches; \"stipple dictionary\" makes "
                            "one");
    if (network) {
        options.plug_and_play.denoiser =
            network_denoiser(file, read_file(file), options.plug_and_play.network_frames);
        return;
    }
    const NpyVolume volume = read_npy_volume(file);
    options.hitomi2011.dictionary =
        patch_dictionary({volume.layers, volume.rows, volume.cols}, volume.values, file);
}

}  // namespace stipple
