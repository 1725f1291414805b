#include "tests/fuzz/image_fuzz.h"

/// Input: a video file, in any container.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const NamedMemoryFile file({data, size}, ".mkv");
    read_footage(file.path(), {});
    return 0;
}
