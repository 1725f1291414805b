#include "tests/fuzz/image_fuzz.h"

/// Input: a .npy file, after a byte that says how it is read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    if (size == 0) return 0;
    FootageOptions options;
    options.transfer = static_cast<Transfer>(data[0] % 3U);
    options.luminance = (data[0] & 4U) != 0;
    if ((data[0] & 8U) != 0) options.max_value = 1;
    const NamedMemoryFile file({data + 1, size - 1}, ".npy");
    read_footage(file.path(), options);
    return 0;
}
