#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// An array of finite numbers in row-major order.
struct Tensor {
    std::vector<std::int64_t> shape;
    std::vector<float> values;
};

/// "40 x 52 x 3 x 3".
[[nodiscard]] std::string shape_text(std::span<const std::int64_t> shape);

/// The content of a file of the format safetensors.
struct TensorFile {
    std::map<std::string, Tensor> tensors;
    std::map<std::string, std::string> metadata;  ///< texts of the key `__metadata__`
};

/// Reads tensors of the types F16 and F32. \throws InputError at `where` if the bytes are not of
/// the format, the tensors do not fill the file without gaps, or a number is not finite.
[[nodiscard]] TensorFile parse_safetensors(std::span<const std::uint8_t> bytes,
                                           std::string_view where);

}  // namespace stipple
