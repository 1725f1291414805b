#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/flux_video.h"
#include "decoder/motion/motion.h"

namespace stipple {

class SampleNoise;
struct Measurements;

inline constexpr int kRefinementInputs = 15;
/// The key `inputs` of a network's metadata, of those that this program computes.
inline constexpr std::string_view kRefinementInputsName = "2";

/// An estimate of a block in the domain of the refinement network,
///
///     v = sqrt(u x + offset),   offset = min(max(u Var(0) / (32 Var'), 0.002), 1000),
///
/// with the variance Var of a sample without light, its increase Var' per light, and u = 1 / (1000
/// Var'), so that light has the shot noise that it has in the sensor `paper`, whatever its unit is.
/// Without noise (Calibration::noise_free) u = 1 and the offset is 0.5, as in `best`.
/// What the network sees of each voxel of a plane:
///
///     0       v
///     1       v of the start estimate - v
///     2..5    v of the slots t - 2, t - 1, t + 1, t + 2 along motion - v, times the confidence
///     6       residual q = 2 u r / v, with r the share of the voxel in y - A x of its sample
///             (A^T (A A^T)^-1); 0 without a sample, and where a saturated one has no more light
///     7       length l = log2(n) / 3 of the exposure, n open slots (weighted: w sum(w^2)); -1
///             without one
///     8       1 if its sample is saturated, else 0
///     9, 10   q of the slots t - 1 and t + 1
///     11, 12  l of these
///     13      noise left in the estimate: log2(noise gain of `filter_groups`) / 5; -1 if unknown
///     14      20 u sqrt(Var(0)); -1 without noise
///
/// At the ends of the block the slot itself takes the place of those that are missing. All values
/// are clipped to -2..2, but the first to at most `kMaxRoot`.
class RefinementInputs {
  public:
    static constexpr float kMaxRoot = 4;

    /// What is known of a block. They outlive the inputs.
    struct Estimates {
        const FluxVideo& estimate;
        const FluxVideo& start;                 ///< may be the estimate
        const FluxVideo* noise_gain = nullptr;  ///< of the estimate; null or empty: not known
        [[nodiscard]] bool knows_noise_gain() const {
            return noise_gain != nullptr && noise_gain->voxels() > 0;
        }
    };

    /// Precondition: equal shapes; one sensor; `measurements` outlive this.
    RefinementInputs(const Measurements& measurements, const SampleNoise& noise,
                     const Estimates& estimates);

    /// Writes the inputs of a plane, order (input, row, col). The same bits for any thread count.
    void write(int slot, int plane, std::span<float> inputs) const;

    /// The light of the plane whose root the network has changed from v to `refined`: x +
    /// (refined^2 - v^2) / u, at least -offset / u. Beyond kMaxRoot it is the change of the input
    /// that is added to v.
    void restore(int slot, int plane, std::span<const float> refined, std::span<float> light) const;

  private:
    struct Point {
        float row, col;
        float confidence;
    };

    void trace_exposures(const Measurements& measurements);
    [[nodiscard]] float root_of(float light) const;
    [[nodiscard]] std::size_t voxel(int slot, int plane) const;
    [[nodiscard]] Point follow(Point from, int slot, int step) const;
    void write_neighbour(int slot, int plane, int steps, std::span<float> to) const;
    void write_noise_gain(int slot, int plane, std::span<float> to) const;
    void write_exposures(int slot, int plane, std::span<float> inputs) const;

    FrameShape shape_;
    int slots_;
    float unit_;  ///< u
    float offset_;
    float dark_input_;
    Estimates estimates_;
    std::vector<float> root_;          ///< v
    std::vector<float> residual_;      ///< q, clipped
    std::vector<float> length_;        ///< l
    std::vector<std::uint8_t> bound_;  ///< 1 if saturated
    std::vector<MotionField> motion_;  ///< none if the frame is too small
};

}  // namespace stipple
