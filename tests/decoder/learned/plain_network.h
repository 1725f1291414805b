#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/index.h"
#include "decoder/learned/conv_kernels.h"
#include "decoder/learned/safetensors.h"

namespace stipple {

/// Channels of a picture, order (channel, row, col).
struct Planes {
    int channels = 0, rows = 0, cols = 0;
    std::vector<float> values;

    Planes(int all_channels, int all_rows, int all_cols, std::vector<float> all_values = {});
    [[nodiscard]] std::size_t at(int channel, int row, int col) const {
        return (index(channel) * index(rows) + index(row)) * index(cols) + index(col);
    }
};

[[nodiscard]] FeatureMap map_of(const Planes& planes);
[[nodiscard]] Planes planes_of(const FeatureMap& map);

// The definitions, as loops without tiles, vectors or threads.

/// torch.nn.Conv2d
[[nodiscard]] Planes plain_convolution(const Tensor& weight, const Tensor& bias, const Planes& in,
                                       int step, int padding);
/// torch.nn.ConvTranspose2d with 2 x 2 weights and stride 2
[[nodiscard]] Planes plain_transposed(const Tensor& weight, const Tensor& bias, const Planes& in);
[[nodiscard]] Planes plain_relu(Planes x);
[[nodiscard]] Planes plain_sum(Planes a, const Planes& b);

using Tensors = std::map<std::string, Tensor>;

/// RefinementNetwork::refine for rows and columns that are multiples of 8.
[[nodiscard]] std::vector<float> plain_network(const Tensors& tensors, int blocks, const Planes& x);

struct NetworkSize {
    int inputs = 3;
    int half = 16, quarter = 24, eighth = 8;  ///< channels
    int blocks = 1;
};

/// Evenly distributed values of the order of those at the start of a training.
[[nodiscard]] Tensor random_tensor(std::vector<std::int64_t> shape, std::uint32_t seed);

/// All tensors of a RefinementNetwork.
[[nodiscard]] Tensors random_network(const NetworkSize& size, std::uint32_t seed);

/// A file of the format safetensors, of the type F32, whose metadata has `inputs`.
[[nodiscard]] std::vector<std::uint8_t> safetensors_file(const Tensors& tensors,
                                                         const std::string& inputs = "1");

/// The same of any header and data.
[[nodiscard]] std::vector<std::uint8_t> safetensors_file(const std::string& header,
                                                         const std::vector<std::uint8_t>& data);

}  // namespace stipple
