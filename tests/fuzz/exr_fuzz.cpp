#include "tests/fuzz/picture_fuzz.h"

/// Input: an OpenEXR file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    stipple::read_picture({data, size}, ".exr");
    return 0;
}
