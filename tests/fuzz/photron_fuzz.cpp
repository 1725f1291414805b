#include <algorithm>
#include <array>
#include <fstream>

#include "tests/fuzz/image_fuzz.h"

/// Input: a header of a Photron camera, .cihx or, if it begins with '#', .cih; after a zero byte
/// its frames.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const auto* const end = std::find(data, data + size, std::uint8_t{0});
    const bool is_text = size > 0 && data[0] == '#';
    const NamedMemoryFile header({data, end}, is_text ? ".cih" : ".cihx");
    const NamedMemoryFile frames({std::min(end + 1, data + size), data + size}, ".mraw");
    read_footage(header.path(), {});
    return 0;
}
