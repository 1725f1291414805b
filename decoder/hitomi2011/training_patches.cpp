#include "decoder/hitomi2011/ksvd.h"

#include <algorithm>
#include <cmath>

#include "core/philox.h"

namespace stipple {
namespace {

/// Draws of each frame that completes a patch in time.
constexpr int kDraws = 256;

constexpr double kMinContrast = 0.02;

/// 0 .. range - 1
int below(std::uint32_t random, int range) {
    return static_cast<int>(std::uint64_t{random} * static_cast<std::uint64_t>(range) >> 32U);
}

/// One of the eight symmetries of a square.
struct Symmetry {
    bool transposed;
    bool flipped_rows;
    bool flipped_cols;

    [[nodiscard]] std::size_t pixel(int row, int col, int side) const {
        if (transposed) std::swap(row, col);
        if (flipped_rows) row = side - 1 - row;
        if (flipped_cols) col = side - 1 - col;
        return row_major(row, col, side);
    }
};

/// Divides a patch by its mean; false without contrast.
bool normalise(std::span<float> patch) {
    double sum = 0;
    double squares = 0;
    for (const float light : patch) {
        sum += static_cast<double>(light);
        squares += static_cast<double>(light) * static_cast<double>(light);
    }
    const auto n = static_cast<double>(patch.size());
    const double mean = sum / n;
    const double variance = squares / n - mean * mean;
    if (!(mean > 0) || !(variance > kMinContrast * kMinContrast * mean * mean)) return false;
    for (float& light : patch) light = static_cast<float>(static_cast<double>(light) / mean);
    return true;
}

}  // namespace

TrainingPatches::TrainingPatches(AtomShape shape, std::size_t max_patches, std::uint64_t seed)
    : shape_(shape), max_patches_(max_patches), seed_(seed), patch_(shape.voxels()) {}

void TrainingPatches::begin_clip(FrameShape shape) {
    frame_shape_ = shape;
    frames_.clear();
}

void TrainingPatches::add_frame(std::span<const float> frame) {
    if (frames_.size() == index(shape_.slots)) {
        std::rotate(frames_.begin(), frames_.begin() + 1, frames_.end());
        std::ranges::copy(frame, frames_.back().begin());
    } else {
        frames_.emplace_back(frame.begin(), frame.end());
    }
    if (frames_.size() == index(shape_.slots))
        for (int i = 0; i < kDraws; ++i) draw_patch();
}

void TrainingPatches::draw_patch() {
    const auto counter = [this](std::uint32_t word) {
        return PhiloxCounter{static_cast<std::uint32_t>(draws_),
                             static_cast<std::uint32_t>(draws_ >> 32U), word, 0};
    };
    const auto [r0, r1, r2, r3] = philox4x32(counter(0), seed_);
    const PhiloxCounter place = philox4x32(counter(1), seed_);
    ++draws_;
    const int side = shape_.side_px;
    const int top = below(r0, frame_shape_.rows - side + 1);
    const int left = below(r1, frame_shape_.cols - side + 1);
    const std::size_t plane = index(below(r2, frame_shape_.planes)) * frame_shape_.pixels();
    const Symmetry symmetry{(r3 & 1U) != 0, (r3 & 2U) != 0, (r3 & 4U) != 0};
    const bool reversed = (r3 & 8U) != 0;
    for (int slot = 0; slot < shape_.slots; ++slot) {
        const auto& frame = frames_[index(reversed ? shape_.slots - 1 - slot : slot)];
        const auto to = std::span(patch_).subspan(index(slot) * shape_.pixels(), shape_.pixels());
        for (int row = 0; row < side; ++row)
            for (int col = 0; col < side; ++col)
                to[symmetry.pixel(row, col, side)] =
                    frame[plane + row_major(top + row, left + col, frame_shape_.cols)];
    }
    if (!normalise(patch_)) return;
    // Reservoir sampling: each patch seen so far is kept with the same probability.
    ++seen_;
    if (patches() < max_patches_) {
        patches_.insert(patches_.end(), patch_.begin(), patch_.end());
        return;
    }
    const std::uint64_t random = std::uint64_t{place[0]} << 32U | place[1];
    const std::uint64_t slot = random % seen_;
    if (slot < max_patches_)
        std::ranges::copy(patch_,
                          patches_.begin() + static_cast<std::ptrdiff_t>(slot * shape_.voxels()));
}

}  // namespace stipple
