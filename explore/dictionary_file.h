#pragma once

namespace stipple {

struct DecodeOptions;

/// Reads the dictionary of patches that the options name, if they name one (decoder/ reads no
/// files). \throws InputError if there is no such file, and as read_npy_volume and
/// patch_dictionary.
void read_dictionary(DecodeOptions& options);

}  // namespace stipple
