#pragma once

namespace stipple {

struct DecodeOptions;

/// Reads the dictionary of patches that the options name, if they name one. \throws InputError as
/// read_npy_volume and patch_dictionary.
void read_dictionary(DecodeOptions& options);

}  // namespace stipple
