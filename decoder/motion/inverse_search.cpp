// Compiled once per SIMD target by foreach_target.h, chosen at run time. Sums of patches are in
// integers, so every target gives the same bits.
#include "decoder/motion/inverse_search.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/motion/inverse_search.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/light.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

constexpr int kSide = kFlowPatchSide;
constexpr int kPixels = kSide * kSide;
constexpr int kFractionBits = 6;  // of a place between pixels
constexpr int kFraction = 1 << kFractionBits;
static_assert(kFraction == kFlowShiftsPerPixel);
constexpr int kValueBits = 4;  // of a value between grey levels

/// Shift of a patch, in pixels.
struct Shift {
    float row = 0;
    float col = 0;
};

/// What a patch is compared by; differences of neighbours are twice the gradient.
struct Patch {
    alignas(64) std::int16_t value[kPixels];  ///< 2^kValueBits per grey level
    alignas(64) std::int16_t across[kPixels];
    alignas(64) std::int16_t down[kPixels];
    float mean_across;
    float mean_down;
    float inverse[3];  ///< of the matrix of gradients: across across, across down, down down
};

/// Sums over a patch of its difference d to where it may have gone.
struct Difference {
    float across;  ///< gradient across times d
    float down;
    float error;  ///< squared d less its mean
};

/// Sums of products of two patches; exact for any order of them.
int dot(const std::int16_t* HWY_RESTRICT a, const std::int16_t* HWY_RESTRICT b) {
    int sum = 0;
    for (int i = 0; i < kPixels; ++i) sum += a[i] * b[i];
    return sum;
}

int total(const std::int16_t* HWY_RESTRICT a) {
    int sum = 0;
    for (int i = 0; i < kPixels; ++i) sum += a[i];
    return sum;
}

float covariance(const std::int16_t* a, float mean_a, const std::int16_t* b) {
    return static_cast<float>(dot(a, b)) - mean_a * static_cast<float>(total(b));
}

void load_rows(const FlowImage& image, int row, int col, Patch& patch) {
    const std::ptrdiff_t stride = image.stride;
    const std::uint8_t* HWY_RESTRICT at = image.pixels + row * stride + col;
    for (int i = 0; i < kPixels; i += kSide, at += stride)
        for (int k = 0; k < kSide; ++k) {
            patch.value[i + k] = static_cast<std::int16_t>(at[k] << kValueBits);
            patch.across[i + k] = static_cast<std::int16_t>(at[k + 1] - at[k - 1]);
            patch.down[i + k] = static_cast<std::int16_t>(at[k + stride] - at[k - stride]);
        }
}

void load_patch(const FlowImage& image, int row, int col, Patch& patch) {
    load_rows(image, row, col, patch);
    patch.mean_across = static_cast<float>(total(patch.across)) / kPixels;
    patch.mean_down = static_cast<float>(total(patch.down)) / kPixels;
    constexpr float kFlat = 1000;  // squared differences of a patch without texture
    const float aa = covariance(patch.across, patch.mean_across, patch.across) + kFlat;
    const float ad = covariance(patch.across, patch.mean_across, patch.down);
    const float dd = covariance(patch.down, patch.mean_down, patch.down) + kFlat;
    const float scale = 2.0F / (1 << kValueBits) / (aa * dd - ad * ad);
    patch.inverse[0] = dd * scale;
    patch.inverse[1] = -ad * scale;
    patch.inverse[2] = aa * scale;
}

/// A place between pixels, which a patch's first pixel may be at.
struct Place {
    const std::uint8_t* pixel;
    int below;  ///< in 1 / kFraction
    int right;
};

Place place_of(const FlowImage& image, int row, int col, Shift shift) {
    const auto split = [](int at, float by, int last) {
        const float far = std::clamp(static_cast<float>(at) + by, -static_cast<float>(kSide),
                                     static_cast<float>(last));
        return static_cast<int>((far + kSide) * kFraction + 0.5F);
    };
    const int y = split(row, shift.row, image.rows);
    const int x = split(col, shift.col, image.cols);
    return {
        image.pixels + ((y >> kFractionBits) - kSide) * image.stride + (x >> kFractionBits) - kSide,
        y % kFraction, x % kFraction};
}

/// The patch at a place; values as in Patch.
void sample(const Place& place, std::ptrdiff_t stride, std::int16_t* HWY_RESTRICT value) {
    constexpr int kUpToTen = 4;  // bits: 14 bits become 10, so that 6 more fit into 16
    constexpr int kDown = 2 * kFractionBits - kUpToTen - kValueBits;
    const auto right = static_cast<std::uint16_t>(place.right);
    const auto left = static_cast<std::uint16_t>(kFraction - place.right);
    const auto below = static_cast<std::uint16_t>(place.below);
    const auto above = static_cast<std::uint16_t>(kFraction - place.below);
    std::uint16_t across[kPixels + kSide];
    const std::uint8_t* HWY_RESTRICT at = place.pixel;
    for (int i = 0; i < kPixels + kSide; i += kSide, at += stride)
        for (int k = 0; k < kSide; ++k) {
            const auto sum = static_cast<std::uint16_t>(at[k] * left + at[k + 1] * right);
            across[i + k] = static_cast<std::uint16_t>(sum >> kUpToTen);
        }
    for (int i = 0; i < kPixels; ++i) {
        const auto sum = static_cast<std::uint16_t>(across[i] * above + across[i + kSide] * below);
        value[i] = static_cast<std::int16_t>(sum >> kDown);
    }
}

Difference compare(const Patch& patch, const Place& place, std::ptrdiff_t stride) {
    alignas(64) std::int16_t d[kPixels];
    sample(place, stride, d);
    for (int i = 0; i < kPixels; ++i) d[i] = static_cast<std::int16_t>(d[i] - patch.value[i]);
    const auto all = static_cast<float>(total(d));
    return {static_cast<float>(dot(patch.across, d)) - patch.mean_across * all,
            static_cast<float>(dot(patch.down, d)) - patch.mean_down * all,
            static_cast<float>(dot(d, d)) - all * all / kPixels};
}

/// Shifts of patches on a grid whose last row and column end with the image.
class PatchGrid {
  public:
    PatchGrid(const FlowImage& from, const FlowImage& to, int stride)
        : from_(from),
          to_(to),
          stride_(stride),
          rows_((from.rows - kSide + stride - 1) / stride + 1),
          cols_((from.cols - kSide + stride - 1) / stride + 1),
          shift_(patch_index(rows_, 0)) {}

    void start_from(const DenseFlow& coarser) {
        for (int i = 0; i < rows_; ++i)
            for (int k = 0; k < cols_; ++k) {
                const int row = std::min((row_of(i) + kSide / 2) / 2, coarser.rows - 1);
                const int col = std::min((col_of(k) + kSide / 2) / 2, coarser.cols - 1);
                const std::size_t at = row_major(row, col, coarser.cols);
                constexpr float kScale = 2.0F / kFraction;
                shift_[patch_index(i, k)] = {kScale * coarser.row_shift[at],
                                             kScale * coarser.col_shift[at]};
            }
    }
    void search() {
        for (int i = 0; i < rows_; ++i)
            for (int k = 0; k < cols_; ++k) improve(i, k, -1);
        for (int i = rows_ - 1; i >= 0; --i)
            for (int k = cols_ - 1; k >= 0; --k) improve(i, k, 1);
    }
    [[nodiscard]] DenseFlow dense() const;
    /// Each shift becomes the mean of those around it, which count the less the more they differ:
    /// noise goes, borders of motion stay.
    void smooth(float range_sigma_px);

  private:
    [[nodiscard]] int row_of(int i) const { return std::min(i * stride_, from_.rows - kSide); }
    [[nodiscard]] int col_of(int k) const { return std::min(k * stride_, from_.cols - kSide); }
    [[nodiscard]] std::size_t patch_index(int i, int k) const { return row_major(i, k, cols_); }
    /// Takes the shift of a neighbour `side` before or after the patch if that is better, descends.
    void improve(int i, int k, int side);

    const FlowImage& from_;
    const FlowImage& to_;
    int stride_;  ///< pixels
    int rows_;
    int cols_;
    std::vector<Shift> shift_;
};

void PatchGrid::improve(int i, int k, int side) {
    Patch patch;
    const int row = row_of(i);
    const int col = col_of(k);
    load_patch(from_, row, col, patch);
    const auto compare_at = [&](const Shift& shift) {
        return compare(patch, place_of(to_, row, col, shift), to_.stride);
    };
    const Shift start = shift_[patch_index(i, k)];
    Shift best = start;
    Difference difference = compare_at(best);
    const auto consider = [&](const Shift& other) {
        const Difference found = compare_at(other);
        if (found.error < difference.error) {
            best = other;
            difference = found;
        }
    };
    if (i + side >= 0 && i + side < rows_) consider(shift_[patch_index(i + side, k)]);
    if (k + side >= 0 && k + side < cols_) consider(shift_[patch_index(i, k + side)]);
    constexpr int kDescents = 3;
    const bool descended = side > 0 && best.row == start.row && best.col == start.col;
    for (int step = 0; !descended && step < kDescents; ++step) {
        const float col_step =
            patch.inverse[0] * difference.across + patch.inverse[1] * difference.down;
        const float row_step =
            patch.inverse[1] * difference.across + patch.inverse[2] * difference.down;
        constexpr float kSmallest = 1.0F / 32;
        if (std::max(std::abs(col_step), std::abs(row_step)) < kSmallest) break;
        const Shift next{best.row - row_step, best.col - col_step};
        if (std::max(std::abs(next.row - start.row), std::abs(next.col - start.col)) > kSide) break;
        const float before = difference.error;
        consider(next);
        if (difference.error >= before) break;
    }
    shift_[patch_index(i, k)] = best;
}

void PatchGrid::smooth(float range_sigma_px) {
    const float decline = 1 / (range_sigma_px * range_sigma_px);
    const std::vector<Shift> old = shift_;
    const auto mean_around = [&](int i, int k) {
        const Shift& own = old[patch_index(i, k)];
        Shift sum;
        float weights = 0;
        for (int y = std::max(0, i - 1); y <= std::min(rows_ - 1, i + 1); ++y)
            for (int x = std::max(0, k - 1); x <= std::min(cols_ - 1, k + 1); ++x) {
                const Shift& other = old[patch_index(y, x)];
                const float down = other.row - own.row;
                const float right = other.col - own.col;
                const float weight = 1 / (1 + decline * (down * down + right * right));
                sum.row += weight * other.row;
                sum.col += weight * other.col;
                weights += weight;
            }
        return Shift{sum.row / weights, sum.col / weights};
    };
    for (int i = 0; i < rows_; ++i)
        for (int k = 0; k < cols_; ++k) shift_[patch_index(i, k)] = mean_around(i, k);
}

/// Weighted sums of shifts over the patches that cover a pixel.
struct Votes {
    explicit Votes(std::size_t pixels) : weight(pixels), row(pixels), col(pixels) {}
    std::vector<float> weight;
    std::vector<float> row;
    std::vector<float> col;
};

void add_votes(const std::uint8_t* HWY_RESTRICT here, const std::int16_t* HWY_RESTRICT there,
               Shift shift, std::size_t first, Votes& votes) {
    constexpr int kLevel = 1 << kValueBits;
    float* HWY_RESTRICT weight = &votes.weight[first];
    float* HWY_RESTRICT row = &votes.row[first];
    float* HWY_RESTRICT col = &votes.col[first];
    for (int i = 0; i < kSide; ++i) {
        const int difference = std::abs(there[i] - here[i] * kLevel);
        const float w = kLevel / static_cast<float>(std::max(difference, kLevel));
        weight[i] += w;
        row[i] += w * shift.row;
        col[i] += w * shift.col;
    }
}

/// To fixed point; what goes too far to be said goes far.
void divide(std::span<const float> sum, std::span<const float> weight,
            std::span<std::int16_t> shift) {
    constexpr float kFarthest = 250;  // pixels; twice that can still be said
    for (std::size_t i = 0; i < shift.size(); ++i) {
        const float pixels = std::clamp(sum[i] / weight[i], -kFarthest, kFarthest);
        shift[i] =
            static_cast<std::int16_t>(static_cast<int>((pixels + kFarthest) * kFraction + 0.5F) -
                                      static_cast<int>(kFarthest * kFraction));
    }
}

DenseFlow PatchGrid::dense() const {
    const auto pixels = static_cast<std::size_t>(from_.rows) * static_cast<std::size_t>(from_.cols);
    Votes votes(pixels);
    for (int i = 0; i < rows_; ++i)
        for (int k = 0; k < cols_; ++k) {
            const int row = row_of(i);
            const int col = col_of(k);
            const std::uint8_t* at = from_.pixels + row * from_.stride + col;
            std::size_t first = row_major(row, col, from_.cols);
            alignas(64) std::int16_t there[kPixels];
            sample(place_of(to_, row, col, shift_[patch_index(i, k)]), to_.stride, there);
            for (int p = 0; p < kPixels; p += kSide, at += from_.stride) {
                add_votes(at, there + p, shift_[patch_index(i, k)], first, votes);
                first += static_cast<std::size_t>(from_.cols);
            }
        }
    DenseFlow flow{from_.rows, from_.cols, std::vector<std::int16_t>(pixels),
                   std::vector<std::int16_t>(pixels)};
    divide(votes.row, votes.weight, flow.row_shift);
    divide(votes.col, votes.weight, flow.col_shift);
    return flow;
}

DenseFlow search_images(const FlowImage& from, const FlowImage& to, const DenseFlow* coarser,
                        const InverseSearchOptions& options) {
    PatchGrid grid(from, to, options.patch_stride_px);
    if (coarser != nullptr) grid.start_from(*coarser);
    grid.search();
    constexpr int kSmoothings = 6;
    for (int i = 0; i < kSmoothings; ++i) grid.smooth(options.range_sigma_px);
    return grid.dense();
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace stipple {

std::vector<std::uint8_t> grey_levels(const FluxVideo& video, int slot) {
    std::span<const float> light = video.frame(slot);
    std::vector<float> luminance;
    if (video.shape().planes == 3) {
        luminance.resize(video.shape().pixels());
        reduce_to_luminance(light, luminance);
        light = luminance;
    }
    std::vector<std::uint8_t> levels(light.size());
    std::ranges::transform(light, levels.begin(), [](float value) {
        return static_cast<std::uint8_t>(255 * std::sqrt(std::clamp(value, 0.0F, 1.0F)) + 0.5F);
    });
    return levels;
}

HWY_EXPORT(search_images);

DenseFlow inverse_search(const FlowImage& from, const FlowImage& to, const DenseFlow* coarser,
                         const InverseSearchOptions& options) {
    return HWY_DYNAMIC_DISPATCH(search_images)(from, to, coarser, options);
}

}  // namespace stipple
#endif  // HWY_ONCE
