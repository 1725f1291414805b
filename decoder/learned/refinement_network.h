#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/learned/conv_kernels.h"

namespace stipple {

class TensorReader;

/// Adds a correction to a picture. The network is a U-Net of three levels at 1/2, 1/4 and 1/8 of
/// the picture's size, whose blocks are x + b(relu(a(x))) with convolutions a and b of 3 x 3
/// (Ronneberger et al., MICCAI 2015; He et al., CVPR 2016). As PyTorch, with the names of tensors:
///
///     h = e1(i(pixel_unshuffle(x, 2)));  g = e2(d1(h));  q = m(d2(g))
///     g = f2(g + u2(q));  h = f1(h + u1(g));  result = x[0] + pixel_shuffle(o(h), 2)
///
/// with Conv2d(3, padding=1) i and o, Conv2d(2, stride=2) d1 and d2, ConvTranspose2d(2, stride=2)
/// u1 and u2, and `blocks` blocks each in e1, e2, m, f2 and f1, called e1.0.a, e1.0.b, e1.1.a ...
class RefinementNetwork {
  public:
    /// Weights of a file of the format safetensors, types F16 and F32. Widths, blocks and inputs
    /// follow from the shapes of the tensors. \throws InputError if the file cannot be read, is not
    /// of the format, is larger than 256 MiB, or its tensors are not those of the network: 1..32
    /// inputs, 1..16 blocks, widths of multiples of 8 up to 256, finite values.
    [[nodiscard]] static RefinementNetwork read(const std::filesystem::path& file);
    /// The same of the bytes of a file that messages call `where`.
    [[nodiscard]] static RefinementNetwork parse(std::span<const std::uint8_t> bytes,
                                                 std::string_view where);

    [[nodiscard]] int inputs() const { return inputs_; }
    [[nodiscard]] const std::map<std::string, std::string>& metadata() const { return metadata_; }
    /// Products of a weight and a value that a picture of this size takes.
    [[nodiscard]] std::int64_t products(int rows, int cols) const;

    /// `planes` has the order (input, row, col), the picture first; `out` (row, col). Rows and
    /// columns are padded at the bottom and right to multiples of 8 by repeating the edge, and the
    /// result is cropped. Padding changes the result near these edges: the network is trained on
    /// multiples of 8. The same bits for any number of threads and SIMD target. With the widths w1,
    /// w2 and w3 it takes about 4 inputs + 2 w1 + w2 / 2 + w3 / 8 bytes of memory per pixel.
    /// Preconditions: rows, cols >= 1, the sizes match; values so small that no sum exceeds the
    /// range of float.
    void refine(std::span<const float> planes, int rows, int cols, std::span<float> out) const;

  private:
    /// Sizes that follow from the tensors.
    struct Widths {
        explicit Widths(const TensorReader& tensors);

        int inputs, half, quarter, eighth;  ///< channels
        int blocks = 0;
    };
    /// x + b(relu(a(x)))
    struct Block {
        ConvolutionWeights a, b;
    };
    using Blocks = std::vector<Block>;

    RefinementNetwork(TensorReader& tensors, const Widths& width);

    static Blocks read_blocks(TensorReader& tensors, std::string_view name, int blocks, int width);
    static void apply(const Blocks& blocks, FeatureMap& x);
    /// o(h), from the channels of pixel_unshuffle.
    [[nodiscard]] FeatureMap correction(const FeatureMap& in) const;

    int inputs_;
    ConvolutionWeights first_, last_, down1_, down2_;
    TransposedWeights up1_, up2_;
    Blocks encoder1_, encoder2_, middle_, decoder2_, decoder1_;
    std::map<std::string, std::string> metadata_;
};

}  // namespace stipple
