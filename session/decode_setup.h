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

/// The same, with the file that the method needs. \throws InputError also as read_option_file.
[[nodiscard]] DecodeSetup read_decode_setup(std::string_view method, Config config);

/// The dictionary of patches or the network that the options name, or the weights of Stipple for a
/// method that needs weights; empty if there is none.
[[nodiscard]] std::string option_file(const DecodeOptions& options);

/// Reads that file, if there is one (decoder/ reads no files). \throws InputError if there is no
/// such file, and as read_npy_volume and patch_dictionary, read_file and network_denoiser, or
/// refinement_of.
void read_option_file(DecodeOptions& options);

}  // namespace stipple
