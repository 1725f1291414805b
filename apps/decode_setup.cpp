#include "apps/decode_setup.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include "apps/fixed_pattern.h"
#include "apps/standard_error.h"
#include "core/config.h"
#include "core/error.h"

namespace stipple {

DecodeSetup read_decode_setup(const DecodeArguments& arguments) {
    const DecodeMethod method = decode_method_from_name(arguments.method);
    if (!arguments.stages.empty() && method != DecodeMethod::kPortz2013)
        throw InputError("--stages",
                         fmt::format("method {} has none; portz2013 has", arguments.method));
    Config config = arguments.options.empty()
                        ? Config(arguments.settings, "decoder")
                        : Config(arguments.options, arguments.settings, "decoder");
    DecodeSetup setup{.options = read_decode_options(method, config), .given = config.as_toml("")};
    setup.options.fill_gaps = arguments.fill_gaps;
    return setup;
}

void calibrate(StreamReader& reader, const DecodeArguments& arguments) {
    if (arguments.calibration.empty())
        say_warning(fixed_pattern_warning(arguments.stream, reader.header()));
    else
        reader.use_sites(read_sites(arguments.calibration, reader.header()));
}

std::string_view schedule_hint(const StreamReport& report) {
    return report.undue_packets == 0
               ? ""
               : "\n  the chip may have run another schedule: --check-schedule looks for it";
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

}  // namespace stipple
