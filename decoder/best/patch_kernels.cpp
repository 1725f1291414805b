// Compiled once per SIMD target by foreach_target.h, chosen at run time. The loops over patches and
// columns are left to the compiler's vectoriser; every target gives the same bits.
#include "decoder/best/patch_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/best/patch_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

constexpr int kSide = kPatchSide;
constexpr int kPixels = kSide * kSide;
constexpr int kPatches = kGroupPatches;

float squared_difference(const float* HWY_RESTRICT a, const float* HWY_RESTRICT b,
                         std::ptrdiff_t cols) {
    constexpr int kLanes = 8;  // the last two do not count
    float sum[kLanes] = {};
    for (int row = 0; row < kSide; ++row, a += cols, b += cols)
        for (int i = 0; i < kLanes; ++i) sum[i] += (a[i] - b[i]) * (a[i] - b[i]);
    return (sum[0] + sum[1]) + (sum[2] + sum[3]) + (sum[4] + sum[5]);
}

void all_squared_differences(const float* image, const float* reference,
                             std::span<const std::uint32_t> at, std::ptrdiff_t cols,
                             float* result) {
    for (std::size_t i = 0; i < at.size(); ++i)
        result[i] = squared_difference(reference, image + at[i], cols);
}

/// Values or coefficients of a group, order (row, col, patch). Variables are not zeroed, which
/// would take a 50th of the time.
struct alignas(64) Group {
    float v[kPixels][kPatches];
};

/// The place of each patch: in the reverse order of bits the Haar transform pairs neighbours.
constexpr int kWhere[kPatches] = {0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};

void load(const GroupFrames& group, const float* from, Group& g) {
    for (std::size_t k = 0; k < kPatches; ++k) {
        const float* row = from + group.patch[k];
        for (int r = 0; r < kSide; ++r, row += group.cols)
            for (int c = 0; c < kSide; ++c) g.v[r * kSide + c][kWhere[k]] = row[c];
    }
}

// The orthonormal DCT of 6 points, by its even and odd halves.
constexpr float kMean = 0.408248290F;   // sqrt(1/6)
constexpr float kFirst = 0.557677536F;  // sqrt(1/3) cos(k pi/12), k = 1, 3, 5
constexpr float kThird = 0.408248290F;
constexpr float kFifth = 0.149429245F;
constexpr float kSecond = 0.5F;          // sqrt(1/3) cos(pi/6)
constexpr float kFourth = 0.288675135F;  // sqrt(1/3) cos(pi/3)
constexpr float kMiddle = 0.577350269F;  // sqrt(1/3)

/// Of all patches at once; the six values of a patch are `stride` apart.
HWY_INLINE void transform(float* HWY_RESTRICT x, int stride) {
    const auto at = [&](int n) { return x + n * stride; };
    for (int i = 0; i < kPatches; ++i) {
        const float even[3] = {at(0)[i] + at(5)[i], at(1)[i] + at(4)[i], at(2)[i] + at(3)[i]};
        const float odd[3] = {at(0)[i] - at(5)[i], at(1)[i] - at(4)[i], at(2)[i] - at(3)[i]};
        at(0)[i] = kMean * (even[0] + even[1] + even[2]);
        at(1)[i] = kFirst * odd[0] + kThird * odd[1] + kFifth * odd[2];
        at(2)[i] = kSecond * (even[0] - even[2]);
        at(3)[i] = kThird * (odd[0] - odd[1] - odd[2]);
        at(4)[i] = kFourth * (even[0] + even[2]) - kMiddle * even[1];
        at(5)[i] = kFifth * odd[0] - kThird * odd[1] + kFirst * odd[2];
    }
}

/// The transpose.
HWY_INLINE void transform_back(float* HWY_RESTRICT x, int stride) {
    const auto at = [&](int n) { return x + n * stride; };
    for (int i = 0; i < kPatches; ++i) {
        const float c0 = kMean * at(0)[i];
        const float c2 = kSecond * at(2)[i];
        const float c4 = kFourth * at(4)[i];
        const float c3 = kThird * at(3)[i];
        const float even[3] = {c0 + c2 + c4, c0 - kMiddle * at(4)[i], c0 - c2 + c4};
        const float odd[3] = {kFirst * at(1)[i] + c3 + kFifth * at(5)[i],
                              kThird * (at(1)[i] - at(5)[i]) - c3,
                              kFifth * at(1)[i] - c3 + kFirst * at(5)[i]};
        for (int n = 0; n < 3; ++n) {
            at(n)[i] = even[n] + odd[n];
            at(kSide - 1 - n)[i] = even[n] - odd[n];
        }
    }
}

/// One level of the Haar transform without its scale: sums before differences. Again, twice its
/// inverse.
template <int kPairs>
HWY_INLINE void pair_up(float* HWY_RESTRICT x) {
    for (int i = 0; i < kPairs; ++i) {
        const float sum = x[i] + x[i + kPairs];
        x[i + kPairs] = x[i] - x[i + kPairs];
        x[i] = sum;
    }
}

/// Squares of the scales that make the Haar transform orthonormal. They are applied where
/// coefficients shrink: g++ 12 would fuse a product with the sums and differences of `pair_up`,
/// whatever -ffp-contract says, and the bits would differ.
constexpr float kHaarSquare[kPatches] = {0.0625F, 0.0625F, 0.125F, 0.125F, 0.25F, 0.25F,
                                         0.25F,   0.25F,   0.5F,   0.5F,   0.5F,  0.5F,
                                         0.5F,    0.5F,    0.5F,   0.5F};

void analyse(Group& g) {
    for (int row = 0; row < kSide; ++row) transform(g.v[row * kSide], kPatches);
    for (int col = 0; col < kSide; ++col) transform(g.v[col], kSide * kPatches);
    for (float* x : g.v) {
        pair_up<8>(x);
        pair_up<4>(x);
        pair_up<2>(x);
        pair_up<1>(x);
    }
}

void synthesise(Group& g) {
    for (float* x : g.v) {
        pair_up<1>(x);
        pair_up<2>(x);
        pair_up<4>(x);
        pair_up<8>(x);
    }
    for (int col = 0; col < kSide; ++col) transform_back(g.v[col], kSide * kPatches);
    for (int row = 0; row < kSide; ++row) transform_back(g.v[row * kSide], kPatches);
}

/// Returns the sum of the squared factors.
float shrink(const Group& pilot, float sigma, Group& g) {
    float squares[kPatches] = {};
    for (int i = 0; i < kPixels; ++i)
        for (int k = 0; k < kPatches; ++k) {
            const float power = kHaarSquare[k] * pilot.v[i][k] * pilot.v[i][k];
            const float factor = power / (power + sigma * sigma);
            g.v[i][k] *= kHaarSquare[k] * factor;
            squares[k] += factor * factor;
        }
    float sum = 0;
    for (const float square : squares) sum += square;
    return sum;
}

float weight_of(float squares) {
    return 1 / (squares > 1 ? squares : 1.0F);
}

/// Along a side of a patch.
constexpr float kWindow[kSide] = {0.45F, 0.8F, 1, 1, 0.8F, 0.45F};

void add(const Group& g, float group_weight, const GroupFrames& group) {
    float window[kPixels];
    for (int i = 0; i < kPixels; ++i)
        window[i] = group_weight * kWindow[i / kSide] * kWindow[i % kSide];
    for (std::size_t k = 0; k < kPatches; ++k) {
        float* HWY_RESTRICT sum = group.sum + group.patch[k];
        float* HWY_RESTRICT weight = group.weight + group.patch[k];
        for (int r = 0; r < kSide; ++r, sum += group.cols, weight += group.cols)
            for (int c = 0; c < kSide; ++c) {
                sum[c] += window[r * kSide + c] * g.v[r * kSide + c][kWhere[k]];
                weight[c] += window[r * kSide + c];
            }
    }
}

/// Adds the windows alone.
void add_windows(const GroupFrames& group) {
    for (const std::ptrdiff_t at : group.patch) {
        float* to = group.window + at;
        for (int r = 0; r < kSide; ++r, to += group.cols)
            for (int c = 0; c < kSide; ++c) to[c] += kWindow[r] * kWindow[c];
    }
}

void load_spectra(const GroupFrames& group, Group& noisy, Group& pilot) {
    load(group, group.noisy, noisy);
    load(group, group.pilot, pilot);
    analyse(noisy);
    analyse(pilot);
}

void wiener_filter(const GroupFrames& group, float sigma) {
    __attribute__((uninitialized)) Group noisy;
    __attribute__((uninitialized)) Group pilot;
    load_spectra(group, noisy, pilot);
    const float weight = weight_of(shrink(pilot, sigma, noisy));
    synthesise(noisy);
    add(noisy, weight, group);
    if (group.window != nullptr) add_windows(group);
}

constexpr std::size_t kColours = 3;

/// Inner product of two planes of a group, without its mean.
float product(const Group& a, const Group& b) {
    float products[kPatches] = {};
    for (int i = 0; i < kPixels; ++i)
        for (int k = 0; k < kPatches; ++k)
            if (i > 0 || k > 0) products[k] += kHaarSquare[k] * a.v[i][k] * b.v[i][k];
    float sum = 0;
    for (const float each : products) sum += each;
    return sum;
}

ColourMatrix axes_of(const Group (&planes)[kColours]) {
    ColourMatrix covariance;
    for (std::size_t i = 0; i < kColours; ++i)
        for (std::size_t j = 0; j <= i; ++j)
            covariance[i][j] = covariance[j][i] = product(planes[i], planes[j]);
    return principal_colour_axes(covariance);
}

/// Each plane becomes the sum of all, times a column of `mix`.
void mix_planes(const ColourMatrix& mix, Group (&planes)[kColours]) {
    for (int i = 0; i < kPixels; ++i)
        for (int k = 0; k < kPatches; ++k) {
            const float x[kColours] = {planes[0].v[i][k], planes[1].v[i][k], planes[2].v[i][k]};
            for (std::size_t p = 0; p < kColours; ++p)
                planes[p].v[i][k] = x[0] * mix[0][p] + x[1] * mix[1][p] + x[2] * mix[2][p];
        }
}

ColourMatrix transposed(const ColourMatrix& m) {
    return {
        {{m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}}};
}

void wiener_filter_colours(const ColourGroupFrames& frames, float sigma) {
    __attribute__((uninitialized)) Group noisy[kColours];
    __attribute__((uninitialized)) Group pilot[kColours];
    for (std::size_t p = 0; p < kColours; ++p) load_spectra(frames[p], noisy[p], pilot[p]);
    const ColourMatrix axes = axes_of(pilot);
    mix_planes(axes, noisy);
    mix_planes(axes, pilot);
    float squares = 0;
    for (std::size_t p = 0; p < kColours; ++p) squares += shrink(pilot[p], sigma, noisy[p]);
    mix_planes(transposed(axes), noisy);
    for (std::size_t p = 0; p < kColours; ++p) {
        synthesise(noisy[p]);
        add(noisy[p], weight_of(squares), frames[p]);
        if (frames[p].window != nullptr) add_windows(frames[p]);
    }
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(all_squared_differences);
HWY_EXPORT(wiener_filter);
HWY_EXPORT(wiener_filter_colours);

void squared_differences(const float* image, const float* reference,
                         std::span<const std::uint32_t> at, std::ptrdiff_t cols,
                         float* result) noexcept {
    HWY_DYNAMIC_DISPATCH(all_squared_differences)(image, reference, at, cols, result);
}

void filter_group(const GroupFrames& group, float sigma) noexcept {
    HWY_DYNAMIC_DISPATCH(wiener_filter)(group, sigma);
}

void filter_group(const ColourGroupFrames& planes, float sigma) noexcept {
    HWY_DYNAMIC_DISPATCH(wiener_filter_colours)(planes, sigma);
}

}  // namespace stipple
#endif  // HWY_ONCE
