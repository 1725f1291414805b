#pragma once

#include <span>
#include <string_view>

namespace stipple {

enum class DecodeMethod {
    kNaive,      ///< each pixel holds its nearest samples; no model of the scene
    kFast,       ///< motion-compensated total variation
    kBest,       ///< collaborative filter of similar blocks
    kPortz2013,  ///< the method of the paper, in two stages
};

struct NamedDecodeMethod {
    std::string_view name;
    DecodeMethod method;
};

/// Every method there is, from the simplest on.
[[nodiscard]] std::span<const NamedDecodeMethod> decode_methods();

/// \throws InputError listing the names of `decode_methods`.
[[nodiscard]] DecodeMethod decode_method_from_name(std::string_view name);

}  // namespace stipple
