#pragma once

#include <array>
#include <span>
#include <vector>

namespace stipple {

/// Side of the blocks of a volume, in pixels; maximum length and number of volumes.
inline constexpr int kBlockSide = 8;
inline constexpr int kBlockPixels = kBlockSide * kBlockSide;
inline constexpr int kMaxVolumeFrames = 17;
inline constexpr int kMaxGroupVolumes = 16;

/// An orthonormal matrix by rows.
struct SquareMatrix {
    int side = 0;
    std::vector<float> values;
};

/// Type II. From the four operations only, so the bits are the same everywhere.
[[nodiscard]] SquareMatrix dct_matrix(int side);

/// Precondition: `side` is a power of 2.
[[nodiscard]] SquareMatrix haar_matrix(int side);

/// The separable transform of a group of volumes, each `frames` blocks along time: DCT in space
/// (rows, columns) and time, Haar transform along the group. Orthonormal. Values are in the order
/// (volume, frame, row, col).
class VolumeTransform {
  public:
    VolumeTransform();

    /// In place. Precondition: group.size() == volumes * frames * kBlockPixels, `volumes` is a
    /// power of 2 and at most kMaxGroupVolumes, 1 <= frames <= kMaxVolumeFrames.
    void forward(int volumes, int frames, std::span<float> group) const;
    /// The inverse.
    void inverse(int volumes, int frames, std::span<float> group) const;

  private:
    using Pair = std::array<SquareMatrix, 2>;  ///< a matrix and its transpose
    Pair space_;
    std::array<Pair, kMaxVolumeFrames + 1> time_;
    std::array<Pair, kMaxGroupVolumes + 1> group_;  ///< of powers of 2
};

}  // namespace stipple
