#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "readout/schedules/tiled_schedule.h"
#include "readout/timing/full_readout.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/slot_readout.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

constexpr int kMaxPixels = 1 << 16;

/// A timing that is accepted reads a full array: by formula and by events alike, without overflow.
void read_in_full(const ReadoutTiming& timing) {
    const FrameShape shape{timing.rows, timing.cols, 1};
    const std::int64_t formula = full_readout(timing, shape).total;
    if (shape.pixels() > kMaxPixels || timing.dark_rows > kMaxPixels) return;
    const ExposureSchedule every_slot = full_schedule(1, 1);
    std::vector<RowLoad> loads;
    RowLoads(timing, every_slot, shape).list(0, loads);
    if (read_slot(timing, shape.cols, loads, 0).end != formula) std::abort();
}

}  // namespace
}  // namespace stipple

/// Input: a sensor file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const stipple::MemoryFile file(std::string(data, data + size));
    try {
        stipple::Config config(file.path(), {});
        const auto timing = stipple::read_timing(config, 12);
        config.reject_unknown_keys();
        if (timing) stipple::read_in_full(*timing);
    } catch (const stipple::InputError&) {
    }
    return 0;
}
