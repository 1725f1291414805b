#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/error.h"
#include "readout/program/program_text.h"

/// A memory image that is accepted comes back from its own text, and so does the schedule in it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    try {
        const auto named = parse_program({reinterpret_cast<const char*>(data), size}, "fuzz.mem");
        if (parse_program(program_text(named), "again").program != named.program) std::abort();
        const ExposureSchedule schedule = schedule_of(named.program, "fuzz.mem");
        if (schedule.interleaved()) return 0;
        if (schedule_of(compile_schedule(schedule), "again") != schedule) std::abort();
    } catch (const InputError&) {
    }
    return 0;
}
