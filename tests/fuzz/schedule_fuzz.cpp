#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "readout/schedules/code_schedule.h"
#include "readout/schedules/schedule_catalogue.h"
#include "tests/support/memory_file.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 8, .cols = 8, .planes = 1};

ExposureSchedule read(const std::string& text) {
    const MemoryFile file(text);
    Config config(file.path(), {"kind=code"});
    return read_schedule(config, kShape, 1).schedule;
}

/// What was written is read back as it is, if it holds one period.
void check_round_trip(const ExposureSchedule& schedule) {
    const ExposureSchedule again = read(code_text(schedule, "again"));
    if (again.period_slots() == schedule.period_slots() && again != schedule) std::abort();
}

}  // namespace
}  // namespace stipple

/// Input: a schedule file of kind "code".
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        stipple::check_round_trip(stipple::read({data, data + size}));
    } catch (const stipple::InputError&) {
    }
    return 0;
}
