#include "tests/fuzz/image_fuzz.h"

/// Input: a PNG file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stipple::read_image({data, size}, ".png");
    return 0;
}
