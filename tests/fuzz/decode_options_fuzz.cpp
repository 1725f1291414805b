#include <cstdint>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "decoder/decode_options.h"
#include "tests/support/memory_file.h"

/// Input: a file of options, read by each method.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const MemoryFile file(std::string(data, data + size));
    for (const NamedDecodeMethod& named : decode_methods()) try {
            Config config(file.path(), {});
            static_cast<void>(read_decode_options(named.method, config));
        } catch (const InputError&) {
            continue;
        }
    return 0;
}
