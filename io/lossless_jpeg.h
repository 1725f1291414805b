#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace stipple {

/// Decodes a lossless JPEG image (ITU-T T.81, process 14: Huffman codes, predictors 1 to 7) into
/// its samples, row after row, components interleaved. Not supported: restart intervals and
/// subsampled components.
/// \throws InputError at `where` if it is damaged, of another process, or does not have
/// samples.size() samples of 2 to 16 bits.
void decode_lossless_jpeg(std::span<const std::uint8_t> jpeg, const std::string& where,
                          std::span<std::uint16_t> samples);

}  // namespace stipple
