#include "session/decode_setup.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "core/input_file.h"
#include "decoder/learned/learned.h"
#include "decoder/plug_and_play/network_denoiser.h"
#include "io/npy_file.h"

namespace stipple {
namespace {

/// \throws InputError with `fault` if there is none.
void require_file(const std::string& file, const char* fault) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) throw InputError(file, fault);
}

/// The weights that the options name, or else those of Stipple, if it has some.
std::string model_file(const LearnedOptions& options) {
    if (!options.model_file.empty()) return options.model_file;
    if (config_names(ConfigKind::kModels).empty()) return {};
    return find_config(ConfigKind::kModels, "refinement").string();
}

}  // namespace

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
        case DecodeMethod::kLearned:
        case DecodeMethod::kLearnedFast:
            return model_file(options.learned);
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
    switch (options.method) {
        case DecodeMethod::kLearned:
        case DecodeMethod::kLearnedFast:
            if (file.empty()) return;
            require_file(file, "there is no such network");
            options.learned.refine = refinement_of(file);
            break;
        case DecodeMethod::kPlugAndPlay:
            if (file.empty()) return;
            require_file(file, "there is no such network");
            options.plug_and_play.denoiser =
                network_denoiser(file, read_file(file), options.plug_and_play.network_frames);
            break;
        case DecodeMethod::kHitomi2011: {
            if (file.empty()) return;
            require_file(
                file, "there is no such dictionary of patches; \"stipple dictionary\" makes one");
            const NpyVolume volume = read_npy_volume(file);
            options.hitomi2011.dictionary =
                patch_dictionary({volume.layers, volume.rows, volume.cols}, volume.values, file);
            break;
        }
        default:
            break;
    }
}

}  // namespace stipple
