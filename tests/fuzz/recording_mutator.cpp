#include "tests/fuzz/recording_pieces.h"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
    return stipple::mutate_framed(stipple::kRecordingFormat, {data, most}, size, seed);
}
