#include <algorithm>
#include <string>

#include "tests/fuzz/image_fuzz.h"

/// Input: what stands after --raw in a line of its own, then the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const auto* const end = std::find(data, data + size, std::uint8_t{'\n'});
    if (end == data + size) return 0;
    FootageOptions options;
    try {
        options.raw = parse_raw_format(std::string(data, end));
    } catch (const InputError&) {
        return 0;
    }
    const NamedMemoryFile file({end + 1, data + size}, ".raw");
    read_footage(file.path(), options);
    return 0;
}
