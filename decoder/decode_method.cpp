#include "decoder/decode_method.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "core/error.h"
#include "core/joined.h"

namespace stipple {
namespace {

constexpr NamedDecodeMethod kMethods[] = {
    {"naive", DecodeMethod::kNaive},
    {"fast", DecodeMethod::kFast},
    {"best", DecodeMethod::kBest},
    {"portz2013", DecodeMethod::kPortz2013},
};

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
    throw InputError("decoding method", fmt::format("\"{}\" is none of {}", name, joined(names)));
}

}  // namespace stipple
