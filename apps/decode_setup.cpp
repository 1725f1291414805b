#include "apps/decode.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/fixed_pattern.h"
#include "apps/standard_error.h"
#include "calibration/calibration_file.h"
#include "core/config.h"
#include "core/error.h"
#include "core/text.h"
#include "explore/dictionary_file.h"

namespace stipple {
namespace {

std::vector<std::string> methods_with_stages() {
    std::vector<std::string> names;
    for (const NamedDecodeMethod& method : decode_methods())
        if (method.has_stages) names.emplace_back(method.name);
    return names;
}

}  // namespace

DecodeSetup read_decode_setup(const DecodeArguments& arguments) {
    const DecodeMethod method = decode_method_from_name(arguments.method);
    if (!arguments.stages.empty() && !named(method).has_stages)
        throw InputError("--stages", fmt::format("method {} has none; {} have", arguments.method,
                                                 joined(methods_with_stages())));
    Config config = arguments.options.empty()
                        ? Config(arguments.settings, "decoder")
                        : Config(arguments.options, arguments.settings, "decoder");
    DecodeSetup setup{.options = read_decode_options(method, config), .given = config.as_toml("")};
    read_dictionary(setup.options);
    setup.options.fill_gaps = arguments.fill_gaps;
    return setup;
}

std::string calibration_file(const DecodeArguments& arguments) {
    if (arguments.calibration == kNoCalibration) return {};
    return arguments.calibration.empty() ? calibration_beside(arguments.stream).string()
                                         : arguments.calibration;
}

void calibrate(StreamReader& reader, const DecodeArguments& arguments) {
    const std::string file = calibration_file(arguments);
    if (file.empty()) return say_warning(fixed_pattern_warning(arguments.stream, reader.header()));
    try {
        ChipCalibration calibration = read_calibration(file, reader.header());
        reader.use_sites(std::move(calibration.sites), std::move(calibration.response));
    } catch (const InputError& error) {
        if (!arguments.calibration.empty()) throw;
        throw InputError(arguments.stream,
                         "the calibration beside it cannot be used (--calibration none decodes "
                         "without): " +
                             error.message());
    }
}

nlohmann::ordered_json calibration_json(const DecodeArguments& arguments) {
    const std::string file = calibration_file(arguments);
    return file.empty() ? nlohmann::ordered_json{} : nlohmann::ordered_json(file);
}

std::string calibrated_text(const DecodeArguments& arguments) {
    const std::string file = calibration_file(arguments);
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
