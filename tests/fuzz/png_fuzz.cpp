#include "tests/fuzz/picture_fuzz.h"

/// Input: a PNG file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stipple::read_picture({data, size}, ".png");
    return 0;
}
