#include "decoder/decode_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/joined.h"

namespace stipple {
namespace {

constexpr NamedDecodeMethod kMethods[] = {
    {"naive", DecodeMethod::kNaive},
    {"fast", DecodeMethod::kFast},
};

void read_number(Config& config, std::string_view key, double least, double most, float& value) {
    value = static_cast<float>(config.number(key, static_cast<double>(value), least, most));
}

void read_integer(Config& config, std::string_view key, int least, int most, int& value) {
    value = static_cast<int>(config.integer(key, value, least, most));
}

void read_options(Config& config, MotionTvOptions& fast) {
    read_integer(config, "at_rest.iterations", 0, 10000, fast.at_rest.iterations);
    read_number(config, "at_rest.spatial_weight", 0, 1e4, fast.at_rest.spatial_weight);
    read_number(config, "at_rest.temporal_weight", 0, 1e4, fast.at_rest.temporal_weight);
    read_integer(config, "along_motion.iterations", 0, 10000, fast.along_motion.iterations);
    read_number(config, "along_motion.spatial_weight", 0, 1e4, fast.along_motion.spatial_weight);
    read_number(config, "along_motion.temporal_weight", 0, 1e4, fast.along_motion.temporal_weight);
    read_integer(config, "rounds", 0, 100, fast.rounds);
    read_integer(config, "last_iterations", 0, 10000, fast.last_iterations);
    read_number(config, "step", 1e-6, 1, fast.step);
    read_number(config, "step_flux", 1e-4, 1e4, fast.step_flux);
    read_number(config, "max_step_ratio", 1, 1e4, fast.max_step_ratio);
}

}  // namespace

std::span<const NamedDecodeMethod> decode_methods() {
    return kMethods;
}

DecodeMethod decode_method_from_name(std::string_view name) {
    std::vector<std::string> names;
    for (const NamedDecodeMethod& known : kMethods) {
        if (known.name == name) return known.method;
        names.emplace_back(known.name);
    }
    throw InputError("decoding method", fmt::format("`{}` is none of {}", name, joined(names)));
}

DecodeOptions read_decode_options(DecodeMethod method, Config& config) {
    DecodeOptions options{.method = method};
    switch (method) {
        case DecodeMethod::kNaive:
            break;
        case DecodeMethod::kFast:
            read_options(config, options.fast);
            break;
    }
    config.reject_unknown_keys();
    return options;
}

}  // namespace stipple
