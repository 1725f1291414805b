#include "tests/fuzz/image_fuzz.h"

/// Input: an OpenEXR file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stipple::read_image({data, size}, ".exr");
    return 0;
}
