#include "decoder/learned/refinement_inputs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/motion/bilinear.h"
#include "decoder/pixel_response.h"
#include "decoder/sampling_operator.h"

namespace stipple {
namespace {

constexpr float kMinOffset = 0.002F;
constexpr float kMaxOffset = 1e3F;
constexpr float kOffsetSlots = 32;
constexpr float kPerLight = 1.0F / 1000;  ///< Var' of the sensor `paper`
constexpr float kNoiseFreeOffset = 0.5F;
constexpr float kClip = 2;
constexpr std::array kSteps{-2, -1, 1, 2};  ///< slots of the neighbours in time

float clipped(float value) {
    return std::clamp(value, -kClip, kClip);
}

/// In steps of 2^-20, so that its bits do not hang on a library's logarithm.
float log2_steps(float value) {
    return static_cast<float>(std::round(std::log2(static_cast<double>(value)) * 0x1p20) * 0x1p-20);
}

}  // namespace

RefinementInputs::RefinementInputs(const Measurements& measurements, const SampleNoise& noise,
                                   const Estimates& estimates)
    : shape_(estimates.estimate.shape()),
      slots_(estimates.estimate.slots()),
      unit_(noise.none() ? 1 : kPerLight / noise.per_light()),
      offset_(noise.none()
                  ? kNoiseFreeOffset
                  : std::clamp(unit_ * noise.variance(0) / noise.per_light() / kOffsetSlots,
                               kMinOffset, kMaxOffset)),
      dark_input_(noise.none() ? -1 : clipped(20 * unit_ * std::sqrt(noise.variance(0)))),
      estimates_(estimates),
      root_(estimates.estimate.voxels()),
      residual_(root_.size()),
      length_(root_.size()),
      bound_(root_.size()) {
    const FluxVideo& estimate = estimates.estimate;
    parallel_for(0, slots_, [&](int slot) {
        const auto light = estimate.frame(slot);
        std::ranges::transform(light, &root_[voxel(slot, 0)], [&](float x) { return root_of(x); });
    });
    sample(measurements, estimate.data(), residual_);
    trace_exposures(measurements);
    if (std::min(shape_.rows, shape_.cols) >= kMinMotionSide)
        motion_ = estimate_motion(estimate, {});
}

/// Of the sums A x in `residual_`.
void RefinementInputs::trace_exposures(const Measurements& m) {
    const std::vector<float> ones(m.weight.empty() ? m.voxels() : 0, 1.0F);
    sample(m, m.weight.empty() ? ones : m.weight, length_);  // A A^T
    std::vector<float> bounds(m.voxels());
    const auto for_each_voxel = [&](const auto& body) {
        parallel_for(0, slots_, [&](int slot) {
            for (std::size_t i = voxel(slot, 0); i < voxel(slot + 1, 0); ++i) body(i);
        });
    };
    for_each_voxel([&](std::size_t i) {
        if ((m.state[i] & Measurements::kLast) == 0) return;
        const bool saturated = (m.state[i] & Measurements::kSaturated) != 0;
        const float lack = (m.sum[i] - residual_[i]) / length_[i];
        residual_[i] = saturated ? std::max(lack, 0.0F) : lack;
        bounds[i] = saturated ? 1.0F : 0.0F;
    });
    spread(m, bounds, bounds);
    spread(m, residual_, residual_);
    spread(m, length_, length_);
    for_each_voxel([&](std::size_t i) {
        bound_[i] = bounds[i] > 0 ? 1 : 0;
        residual_[i] = clipped(2 * unit_ * residual_[i] / root_[i]);
        length_[i] = length_[i] > 0 ? clipped(log2_steps(length_[i]) / 3) : -1;
    });
}

float RefinementInputs::root_of(float light) const {
    return std::sqrt(std::max(unit_ * light, 0.0F) + offset_);
}

std::size_t RefinementInputs::voxel(int slot, int plane) const {
    return index(slot) * shape_.sites() + index(plane) * shape_.pixels();
}

/// From a point of `slot` to where it is in slot + step; without confidence beyond the block.
RefinementInputs::Point RefinementInputs::follow(Point from, int slot, int step) const {
    if (slot + step < 0 || slot + step >= slots_) return {};
    if (motion_.empty()) return from;
    const MotionField& field = motion_[step == motion_[0].step ? 0 : 1];
    const int row = static_cast<int>(from.row + 0.5F);
    const int col = static_cast<int>(from.col + 0.5F);
    const std::size_t i = index(slot) * shape_.pixels() + row_major(row, col, shape_.cols);
    constexpr float kPixel = 1.0F / MotionField::kShiftsPerPixel;
    const auto inside = [](float place, int size) {
        return std::clamp(place, 0.0F, static_cast<float>(size - 1));
    };
    return {inside(from.row + kPixel * static_cast<float>(field.row_shift[i]), shape_.rows),
            inside(from.col + kPixel * static_cast<float>(field.col_shift[i]), shape_.cols),
            from.confidence * static_cast<float>(field.confidence[i]) / 255};
}

void RefinementInputs::write_neighbour(int slot, int plane, int steps, std::span<float> to) const {
    const int step = steps < 0 ? -1 : 1;
    const auto roots = [&](int of_slot) {
        return PlaneView<const float>(&root_[voxel(of_slot, plane)], shape_.rows, shape_.cols);
    };
    const PlaneView<const float> own = roots(slot);
    for (int row = 0; row < shape_.rows; ++row)
        for (int col = 0; col < shape_.cols; ++col) {
            Point at{static_cast<float>(row), static_cast<float>(col), 1};
            for (int k = 0; k != steps && at.confidence > 0; k += step)
                at = follow(at, slot + k, step);
            to[row_major(row, col, shape_.cols)] =
                at.confidence > 0
                    ? clipped(at.confidence *
                              (bilinear(roots(slot + steps), at.row, at.col) - own(row, col)))
                    : 0.0F;
        }
}

void RefinementInputs::write_exposures(int slot, int plane, std::span<float> inputs) const {
    const std::size_t pixels = shape_.pixels();
    const auto copy = [&](const auto& from, int of_slot, int input) {
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(voxel(of_slot, plane));
        std::copy(begin, begin + static_cast<std::ptrdiff_t>(pixels),
                  inputs.begin() + static_cast<std::ptrdiff_t>(index(input) * pixels));
    };
    const int before = std::max(slot - 1, 0), after = std::min(slot + 1, slots_ - 1);
    copy(residual_, slot, 6);
    copy(length_, slot, 7);
    copy(bound_, slot, 8);
    copy(residual_, before, 9);
    copy(residual_, after, 10);
    copy(length_, before, 11);
    copy(length_, after, 12);
}

void RefinementInputs::write_noise_gain(int slot, int plane, std::span<float> to) const {
    if (!estimates_.knows_noise_gain()) {
        std::ranges::fill(to, -1.0F);
        return;
    }
    const float* gain = &estimates_.noise_gain->data()[voxel(slot, plane)];
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = log2_steps(gain[i]) / 5;
}

void RefinementInputs::write(int slot, int plane, std::span<float> inputs) const {
    const std::size_t pixels = shape_.pixels();
    const auto input = [&](int i) { return inputs.subspan(index(i) * pixels, pixels); };
    const float* root = &root_[voxel(slot, plane)];
    const float* started = &estimates_.start.data()[voxel(slot, plane)];
    for (std::size_t i = 0; i < pixels; ++i) {
        inputs[i] = std::min(root[i], kMaxRoot);
        input(1)[i] = clipped(root_of(started[i]) - root[i]);
    }
    parallel_for(0, static_cast<int>(kSteps.size()),
                 [&](int i) { write_neighbour(slot, plane, kSteps[index(i)], input(2 + i)); });
    write_exposures(slot, plane, inputs);
    write_noise_gain(slot, plane, input(13));
    std::ranges::fill(input(14), dark_input_);
}

void RefinementInputs::restore(int slot, int plane, std::span<const float> refined,
                               std::span<float> light) const {
    const std::size_t begin = voxel(slot, plane);
    for (std::size_t i = 0; i < light.size(); ++i) {
        const float root = root_[begin + i];
        const float better = std::max(refined[i] + std::max(root - kMaxRoot, 0.0F), 0.0F);
        light[i] = std::max(
            estimates_.estimate.data()[begin + i] + (better - root) * (better + root) / unit_,
            -offset_ / unit_);
    }
}

}  // namespace stipple
