#include <cstdint>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "readout/rig.h"
#include "tests/support/memory_file.h"

/// Input: the file of a rig. What is read has sensors that can be set up, or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const MemoryFile file(std::string(data, data + size));
    try {
        Config config(file.path(), {});
        const Rig rig = read_rig(config);
        for (const RigSensor& sensor : rig.sensors)
            if (sensor.from_reference.is_finite_on({.rows = 9, .cols = 7}))
                static_cast<void>(overlap_pixels(sensor.from_reference, {.rows = 9, .cols = 7}));
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
