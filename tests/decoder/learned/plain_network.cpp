#include "tests/decoder/learned/plain_network.h"

#include <cmath>
#include <utility>

#include "stream/little_endian.h"
#include "tests/support/noise.h"

namespace stipple {
namespace {

/// pixel_unshuffle(x, 2)
Planes unshuffled(const Planes& x) {
    Planes out(4 * x.channels, x.rows / 2, x.cols / 2);
    for (int channel = 0; channel < x.channels; ++channel)
        for (int row = 0; row < x.rows; ++row)
            for (int col = 0; col < x.cols; ++col)
                out.values[out.at(4 * channel + 2 * (row % 2) + col % 2, row / 2, col / 2)] =
                    x.values[x.at(channel, row, col)];
    return out;
}

}  // namespace

Planes::Planes(int all_channels, int all_rows, int all_cols, std::vector<float> all_values)
    : channels(all_channels), rows(all_rows), cols(all_cols), values(std::move(all_values)) {
    values.resize(at(channels, 0, 0));
}

FeatureMap map_of(const Planes& planes) {
    FeatureMap map(planes.channels, planes.rows, planes.cols);
    for (int channel = 0; channel < planes.channels; ++channel)
        for (int row = 0; row < planes.rows; ++row)
            for (int col = 0; col < planes.cols; ++col)
                map.at(channel, row, col) = planes.values[planes.at(channel, row, col)];
    return map;
}

Planes planes_of(const FeatureMap& map) {
    Planes planes(map.channels(), map.rows(), map.cols());
    for (int channel = 0; channel < planes.channels; ++channel)
        for (int row = 0; row < planes.rows; ++row)
            for (int col = 0; col < planes.cols; ++col)
                planes.values[planes.at(channel, row, col)] = map.at(channel, row, col);
    return planes;
}

Planes plain_convolution(const Tensor& weight, const Tensor& bias, const Planes& in, int step,
                         int padding) {
    const int outputs = static_cast<int>(weight.shape[0]);
    const int side = static_cast<int>(weight.shape[2]);
    const auto value_at = [&](int input, int row, int col) {
        const bool inside = row >= 0 && row < in.rows && col >= 0 && col < in.cols;
        return inside ? in.values[in.at(input, row, col)] : 0.0F;
    };
    Planes out(outputs, in.rows / step, in.cols / step);
    for (int output = 0; output < outputs; ++output)
        for (int row = 0; row < out.rows; ++row)
            for (int col = 0; col < out.cols; ++col) {
                float sum = bias.values[index(output)];
                const float* w =
                    &weight.values[index(output) * index(in.channels) * index(side * side)];
                for (int input = 0; input < in.channels; ++input)
                    for (int i = 0; i < side; ++i)
                        for (int j = 0; j < side; ++j)
                            sum += *w++ * value_at(input, step * row + i - padding,
                                                   step * col + j - padding);
                out.values[out.at(output, row, col)] = sum;
            }
    return out;
}

Planes plain_transposed(const Tensor& weight, const Tensor& bias, const Planes& in) {
    const int outputs = static_cast<int>(weight.shape[1]);
    Planes out(outputs, 2 * in.rows, 2 * in.cols);
    for (int output = 0; output < outputs; ++output)
        for (int row = 0; row < out.rows; ++row)
            for (int col = 0; col < out.cols; ++col) {
                float sum = bias.values[index(output)];
                for (int input = 0; input < in.channels; ++input)
                    sum += weight.values[index(input * outputs + output) * 4 +
                                         index(2 * (row % 2) + col % 2)] *
                           in.values[in.at(input, row / 2, col / 2)];
                out.values[out.at(output, row, col)] = sum;
            }
    return out;
}

Planes plain_relu(Planes x) {
    for (float& value : x.values) value = value > 0 ? value : 0.0F;
    return x;
}

Planes plain_sum(Planes a, const Planes& b) {
    for (std::size_t i = 0; i < a.values.size(); ++i) a.values[i] += b.values[i];
    return a;
}

std::vector<float> plain_network(const Tensors& tensors, int blocks, const Planes& x) {
    const auto weight = [&](const std::string& name) { return tensors.at(name + ".weight"); };
    const auto bias = [&](const std::string& name) { return tensors.at(name + ".bias"); };
    const auto same = [&](const std::string& name, const Planes& in) {
        return plain_convolution(weight(name), bias(name), in, 1, 1);
    };
    const auto down = [&](const std::string& name, const Planes& in) {
        return plain_convolution(weight(name), bias(name), in, 2, 0);
    };
    const auto up = [&](const std::string& name, const Planes& in) {
        return plain_transposed(weight(name), bias(name), in);
    };
    const auto all_blocks = [&](const std::string& name, Planes in) {
        for (int i = 0; i < blocks; ++i) {
            const std::string block = name + "." + std::to_string(i);
            in = plain_sum(in, same(block + ".b", plain_relu(same(block + ".a", in))));
        }
        return in;
    };
    Planes h = all_blocks("e1", same("i", unshuffled(x)));
    Planes g = all_blocks("e2", down("d1", h));
    const Planes q = all_blocks("m", down("d2", g));
    g = all_blocks("f2", plain_sum(g, up("u2", q)));
    h = all_blocks("f1", plain_sum(h, up("u1", g)));
    const Planes o = same("o", h);
    std::vector<float> result(index(x.rows) * index(x.cols));
    for (int row = 0; row < x.rows; ++row)
        for (int col = 0; col < x.cols; ++col)
            result[x.at(0, row, col)] = x.values[x.at(0, row, col)] +
                                        o.values[o.at(2 * (row % 2) + col % 2, row / 2, col / 2)];
    return result;
}

Tensor random_tensor(std::vector<std::int64_t> shape, std::uint32_t seed) {
    std::size_t count = 1;
    std::size_t inputs = 1;
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
        count *= index(shape[axis]);
        if (axis > 0) inputs *= index(shape[axis]);
    }
    Tensor tensor{.shape = std::move(shape), .values = noise(count, seed)};
    const float scale = 2 / std::sqrt(static_cast<float>(inputs));
    for (float& value : tensor.values) value = scale * (value - 0.5F);
    return tensor;
}

Tensors random_network(const NetworkSize& size, std::uint32_t seed) {
    Tensors tensors;
    const auto add = [&](const std::string& name, const std::vector<std::int64_t>& shape,
                         int outputs) {
        tensors[name + ".weight"] = random_tensor(shape, ++seed);
        tensors[name + ".bias"] = random_tensor({outputs}, ++seed);
    };
    const auto add_blocks = [&](const std::string& name, int width) {
        for (int i = 0; i < size.blocks; ++i)
            for (const char* part : {".a", ".b"})
                add(name + "." + std::to_string(i) + part, {width, width, 3, 3}, width);
    };
    add("i", {size.half, 4 * size.inputs, 3, 3}, size.half);
    add_blocks("e1", size.half);
    add("d1", {size.quarter, size.half, 2, 2}, size.quarter);
    add_blocks("e2", size.quarter);
    add("d2", {size.eighth, size.quarter, 2, 2}, size.eighth);
    add_blocks("m", size.eighth);
    add("u2", {size.eighth, size.quarter, 2, 2}, size.quarter);
    add_blocks("f2", size.quarter);
    add("u1", {size.quarter, size.half, 2, 2}, size.half);
    add_blocks("f1", size.half);
    add("o", {4, size.half, 3, 3}, 4);
    return tensors;
}

std::vector<std::uint8_t> safetensors_file(const std::string& header,
                                           const std::vector<std::uint8_t>& data) {
    std::vector<std::uint8_t> bytes;
    append(bytes, static_cast<std::uint64_t>(header.size()));
    bytes.insert(bytes.end(), header.begin(), header.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

std::vector<std::uint8_t> safetensors_file(const Tensors& tensors, const std::string& inputs) {
    std::string header = R"({"__metadata__":{"format":"pt","inputs":")" + inputs + "\"}";
    std::vector<std::uint8_t> data;
    for (const auto& [name, tensor] : tensors) {
        std::string shape;
        for (const std::int64_t size : tensor.shape)
            shape += (shape.empty() ? "" : ",") + std::to_string(size);
        header += ",\"" + name + R"(":{"dtype":"F32","shape":[)" + shape + R"(],"data_offsets":[)" +
                  std::to_string(data.size());
        for (const float value : tensor.values) append(data, value);
        header += "," + std::to_string(data.size()) + "]}";
    }
    return safetensors_file(header + "}", data);
}

}  // namespace stipple
