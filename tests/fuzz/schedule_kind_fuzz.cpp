#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/config.h"
#include "core/error.h"
#include "readout/schedules/schedule_catalogue.h"
#include "stream/header_codec.h"
#include "tests/support/memory_file.h"

/// Input: a schedule file of any kind. What is accepted can be put into a stream, and a decoder
/// reads the same from it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    const FrameShape shape{.rows = 16, .cols = 16, .planes = 1};
    const MemoryFile file(std::string(data, data + size));
    try {
        Config config(file.path(), {});
        const NamedSchedule named = read_schedule(config, shape, 1);
        config.reject_unknown_keys();
        const StreamHeader header{shape, 5000, Calibration{},      named.schedule, named.source,
                                  "",    "",   ColourFilter::kNone};
        const auto section = encode_schedule(header, "fuzz");
        if (decode_schedule({named.source.kind, section}, shape, "fuzz").schedule != named.schedule)
            std::abort();
    } catch (const InputError&) {
        return 0;
    }
    return 0;
}
