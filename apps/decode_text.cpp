#include "apps/decode.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

std::vector<std::string> methods_with_stages() {
    std::vector<std::string> names;
    for (const NamedDecodeMethod& method : decode_methods())
        if (method.has_stages) names.emplace_back(method.name);
    return names;
}

std::string used_calibration(const DecodeArguments& arguments) {
    return calibration_file(arguments.stream, calibration_choice(arguments.calibration)).string();
}

}  // namespace

DecodeSetup setup_of(const DecodeArguments& arguments) {
    const DecodeMethod method = decode_method_from_name(arguments.method);
    if (!arguments.stages.empty() && !named(method).has_stages)
        throw InputError("--stages", fmt::format("method {} has none; {} have", arguments.method,
                                                 joined(methods_with_stages())));
    DecodeSetup setup = read_decode_setup(
        arguments.method, arguments.options.empty()
                              ? Config(arguments.settings, "decoder")
                              : Config(arguments.options, arguments.settings, "decoder"));
    setup.options.fill_gaps = arguments.fill_gaps;
    return setup;
}

nlohmann::ordered_json calibration_json(const DecodeArguments& arguments) {
    const std::string file = used_calibration(arguments);
    return file.empty() ? nlohmann::ordered_json{} : nlohmann::ordered_json(file);
}

std::string calibrated_text(const DecodeArguments& arguments) {
    const std::string file = used_calibration(arguments);
    return file.empty() ? "" : fmt::format(", calibrated by {}", file);
}

std::string_view schedule_hint(const StreamReport& report) {
    return report.unexpected_packets == 0
               ? ""
               : "\n  the chip may have run another schedule: --check-schedule looks for it";
}

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

}  // namespace stipple
