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

/// The same, with the files that the options name. \throws InputError also as read_dictionary.
[[nodiscard]] DecodeSetup read_decode_setup(std::string_view method, Config config);

/// Reads the dictionary of patches that the options name, if they name one (decoder/ reads no
/// files). \throws InputError if there is no such file, and as read_npy_volume and
/// patch_dictionary.
void read_dictionary(DecodeOptions& options);

}  // namespace stipple
