#pragma once

#include <string>
#include <string_view>

#include "core/config.h"
#include "decoder/decode_options.h"

namespace stipple {

/// A method with its options.
struct DecodeSetup {
    DecodeOptions options;
    std::string given;  ///< options that the user gave, lines of TOML sorted by key
};

/// The method with the options of `config`. \throws InputError if there is no such method, and as
/// read_decode_options.
[[nodiscard]] DecodeSetup decode_setup(std::string_view method, Config config);

/// The same, with the file that the options name. \throws InputError also as read_option_file.
[[nodiscard]] DecodeSetup read_decode_setup(std::string_view method, Config config);

/// The file that the options name: a dictionary of patches or a network; empty if they name none.
[[nodiscard]] std::string option_file(const DecodeOptions& options);

/// Reads that file, if there is one (decoder/ reads no files), or the weights of Stipple, if the
/// method needs weights. \throws InputError if there is no such file, and as read_npy_volume and
/// patch_dictionary, read_file and network_denoiser, or refinement_of.
void read_option_file(DecodeOptions& options);

}  // namespace stipple
