#include "decoder/learned/refinement_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/error.h"
#include "core/input_file.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "decoder/learned/safetensors.h"

namespace stipple {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{256} << 20U;
constexpr int kMaxInputs = 32;
constexpr int kMaxBlocks = 16;
constexpr int kMaxWidth = 256;
constexpr int kShuffle = 2;                     ///< side of the squares that become channels
constexpr int kShuffled = kShuffle * kShuffle;  ///< channels of a plane
constexpr int kMultiple = 8;                    ///< of the padded rows and columns

int padded(int size) {
    return (size + kMultiple - 1) / kMultiple * kMultiple;
}

/// pixel_unshuffle(planes, 2), padded by the last rows and columns.
FeatureMap unshuffled(std::span<const float> planes, int inputs, int rows, int cols) {
    FeatureMap map(inputs * kShuffled, padded(rows) / kShuffle, padded(cols) / kShuffle);
    parallel_for(0, map.rows(), [&](int row) {
        for (int channel = 0; channel < map.channels(); ++channel) {
            const int i = channel % kShuffled / kShuffle;
            const int j = channel % kShuffle;
            const int from_row = std::min(kShuffle * row + i, rows - 1);
            const float* from = &planes[index(channel / kShuffled) * index(rows) * index(cols) +
                                        row_major(from_row, 0, cols)];
            for (int col = 0; col < map.cols(); ++col)
                map.at(channel, row, col) = from[std::min(kShuffle * col + j, cols - 1)];
        }
    });
    return map;
}

}  // namespace

/// Takes the tensors of a file one by one.
class TensorReader {
  public:
    TensorReader(TensorFile file, std::string_view where) : file_(std::move(file)), where_(where) {}

    [[nodiscard]] bool has(const std::string& name) const { return file_.tensors.contains(name); }

    /// A size of a convolution that follows from its weights. \throws InputError if they are
    /// missing, or the size is not a multiple of `step` up to `max`.
    [[nodiscard]] int size(const std::string& name, std::size_t axis, int step, int max) const {
        const std::string key = name + ".weight";
        const auto& shape = find(key).shape;
        const std::int64_t size = shape.size() == 4 ? shape[axis] : 0;
        if (size == 0 || size % step != 0 || size > max)
            fail(key, fmt::format("has the shape {}, but axis {} of a weight of four axes must be "
                                  "a multiple of {} up to {}",
                                  shape_text(shape), axis, step, max));
        return static_cast<int>(size);
    }

    ConvolutionWeights convolution(const std::string& name, int inputs, int outputs, int side) {
        const auto weight = take(name + ".weight", {outputs, inputs, side, side});
        return stipple::convolution(side, weight, take(name + ".bias", {outputs}));
    }

    TransposedWeights transposed(const std::string& name, int inputs, int outputs) {
        const auto weight = take(name + ".weight", {inputs, outputs, 2, 2});
        return transposed_convolution(weight, take(name + ".bias", {outputs}));
    }

    /// The texts of the file. \throws InputError if a tensor is left.
    std::map<std::string, std::string> end() {
        if (!file_.tensors.empty())
            fail(file_.tensors.begin()->first, "is not one of the network's; leave it out");
        return std::move(file_.metadata);
    }

  private:
    [[noreturn]] void fail(const std::string& name, std::string_view fault) const {
        throw InputError(fmt::format("{}: tensor \"{}\"", where_, name), fault);
    }

    [[nodiscard]] const Tensor& find(const std::string& name) const {
        const auto found = file_.tensors.find(name);
        if (found == file_.tensors.end())
            fail(name, "is missing; write all tensors of the network's state_dict");
        return found->second;
    }

    std::vector<float> take(const std::string& name, const std::vector<std::int64_t>& shape) {
        const auto& found = find(name).shape;
        if (found != shape)
            fail(name, fmt::format("has the shape {}, but the other tensors need {}",
                                   shape_text(found), shape_text(shape)));
        return std::move(file_.tensors.extract(name).mapped().values);
    }

    TensorFile file_;
    std::string where_;
};

RefinementNetwork::Widths::Widths(const TensorReader& tensors)
    : inputs(tensors.size("i", 1, kShuffled, kShuffled * kMaxInputs)),
      half(tensors.size("i", 0, kBlockChannels, kMaxWidth)),
      quarter(tensors.size("d1", 0, kBlockChannels, kMaxWidth)),
      eighth(tensors.size("d2", 0, kBlockChannels, kMaxWidth)) {
    while (blocks < kMaxBlocks && tensors.has(fmt::format("e1.{}.a.weight", blocks))) ++blocks;
}

RefinementNetwork::Blocks RefinementNetwork::read_blocks(TensorReader& tensors,
                                                         std::string_view name, int blocks,
                                                         int width) {
    Blocks result;
    for (int i = 0; i < std::max(blocks, 1); ++i) {
        auto a = tensors.convolution(fmt::format("{}.{}.a", name, i), width, width, 3);
        auto b = tensors.convolution(fmt::format("{}.{}.b", name, i), width, width, 3);
        result.push_back({.a = std::move(a), .b = std::move(b)});
    }
    return result;
}

RefinementNetwork::RefinementNetwork(TensorReader& tensors, const Widths& width)
    : inputs_(width.inputs / kShuffled),
      first_(tensors.convolution("i", width.inputs, width.half, 3)),
      last_(tensors.convolution("o", width.half, kShuffled, 3)),
      down1_(tensors.convolution("d1", width.half, width.quarter, 2)),
      down2_(tensors.convolution("d2", width.quarter, width.eighth, 2)),
      up1_(tensors.transposed("u1", width.quarter, width.half)),
      up2_(tensors.transposed("u2", width.eighth, width.quarter)),
      encoder1_(read_blocks(tensors, "e1", width.blocks, width.half)),
      encoder2_(read_blocks(tensors, "e2", width.blocks, width.quarter)),
      middle_(read_blocks(tensors, "m", width.blocks, width.eighth)),
      decoder2_(read_blocks(tensors, "f2", width.blocks, width.quarter)),
      decoder1_(read_blocks(tensors, "f1", width.blocks, width.half)),
      metadata_(tensors.end()) {}

RefinementNetwork RefinementNetwork::parse(std::span<const std::uint8_t> bytes,
                                           std::string_view where) {
    TensorReader tensors(parse_safetensors(bytes, where), where);
    return {tensors, Widths(tensors)};
}

RefinementNetwork RefinementNetwork::read(const std::filesystem::path& file) {
    refuse_special(file);
    const std::uint64_t bytes = input_bytes(file);
    if (bytes > kMaxFileBytes && bytes != kEndlessInput)
        throw InputError(file.string(), fmt::format("has {} bytes; a network has at most {}", bytes,
                                                    kMaxFileBytes));
    return parse(read_file(file), file.string());
}

void RefinementNetwork::apply(const Blocks& blocks, FeatureMap& x) {
    FeatureMap inner(x.channels(), x.rows(), x.cols());
    for (const Block& block : blocks) {
        convolve(block.a, x, {.relu = true}, inner);
        convolve(block.b, inner, {.add = &x}, x);
    }
}

FeatureMap RefinementNetwork::correction(const FeatureMap& in) const {
    FeatureMap h(first_.outputs, in.rows(), in.cols());
    convolve(first_, in, {}, h);
    apply(encoder1_, h);
    FeatureMap g(down1_.outputs, h.rows() / 2, h.cols() / 2);
    convolve_to_half(down1_, h, g);
    apply(encoder2_, g);
    FeatureMap q(down2_.outputs, g.rows() / 2, g.cols() / 2);
    convolve_to_half(down2_, g, q);
    apply(middle_, q);
    convolve_to_double(up2_, q, {.add = &g}, g);
    apply(decoder2_, g);
    convolve_to_double(up1_, g, {.add = &h}, h);
    apply(decoder1_, h);
    FeatureMap result(last_.outputs, h.rows(), h.cols());
    convolve(last_, h, {}, result);
    return result;
}

void RefinementNetwork::refine(std::span<const float> planes, int rows, int cols,
                               std::span<float> out) const {
    assert(rows >= 1 && cols >= 1);
    assert(out.size() == index(rows) * index(cols));
    assert(planes.size() == index(inputs_) * out.size());
    const FeatureMap added = correction(unshuffled(planes, inputs_, rows, cols));
    parallel_for(0, rows, [&](int row) {
        for (int col = 0; col < cols; ++col) {
            const int channel = row % kShuffle * kShuffle + col % kShuffle;
            const std::size_t i = row_major(row, col, cols);
            out[i] = planes[i] + added.at(channel, row / kShuffle, col / kShuffle);
        }
    });
}

std::int64_t RefinementNetwork::products(int rows, int cols) const {
    const auto of = [](const ConvolutionWeights& weights) {
        return std::int64_t{weights.inputs} * weights.outputs * weights.side * weights.side;
    };
    const auto of_blocks = [&](const Blocks& blocks) {
        std::int64_t sum = 0;
        for (const Block& block : blocks) sum += of(block.a) + of(block.b);
        return sum;
    };
    const std::int64_t half = of(first_) + of(last_) + of_blocks(encoder1_) + of_blocks(decoder1_);
    const std::int64_t quarter =
        of(down1_) + of_blocks(encoder2_) + of_blocks(decoder2_) + 4 * of(up1_[0]);
    const std::int64_t eighth = of(down2_) + of_blocks(middle_) + 4 * of(up2_[0]);
    const std::int64_t pixels = std::int64_t{padded(rows)} * padded(cols);
    return pixels / 4 * half + pixels / 16 * quarter + pixels / 64 * eighth;
}

}  // namespace stipple
