#include "apps/footage_arguments.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <string>

namespace stipple {

void add_footage_arguments(CLI::App& command, FootageOptions& options) {
    static const std::map<std::string, Transfer> kTransfers = {
        {"linear", Transfer::kLinear}, {"gamma22", Transfer::kGamma22}, {"srgb", Transfer::kSrgb}};
    command
        .add_option_function<std::string>(
            "--transfer",
            [&options](const std::string& name) { options.transfer = kTransfers.at(name); },
            "how the numbers of the footage map to light (linear)")
        ->check(CLI::IsMember(kTransfers))
        ->type_name("linear|gamma22|srgb");
    command.add_flag("--luminance", options.luminance, "Rec. 709 luminance of colour footage");
}

void add_max_value(CLI::App& command, std::optional<double>& max_value) {
    command.add_option("--max-value", max_value, "clip light to V first")
        ->check([](const std::string& text) {
            double value = 0;
            const bool usable =
                CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value);
            return usable ? std::string() : "\"" + text + "\" is not a number above 0";
        })
        ->type_name("V");
}

}  // namespace stipple
