#include "tests/fuzz/stream_pieces.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    return stipple::mutate_framed(stipple::kStreamFormat, {data, most}, size, seed);
}
