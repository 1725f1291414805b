#include <cstdint>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "sensor_model/sensor_config.h"
#include "tests/support/memory_file.h"

/// Input: a sensor file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const MemoryFile file(std::string(data, data + size));
    try {
        Config config(file.path(), {});
        static_cast<void>(read_sensor(config));
        config.reject_unknown_keys();
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
