#include "decoder/portz2013/match_admm.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/parallel.h"

namespace stipple {
namespace {

constexpr std::size_t kStretch = 16384;

/// Calls body(first, one past the last, number) for fixed stretches of [0, size).
template <typename Body>
void for_each_stretch(std::size_t size, const Body& body) {
    parallel_for(0, static_cast<int>((size + kStretch - 1) / kStretch), [&](int i) {
        const std::size_t begin = static_cast<std::size_t>(i) * kStretch;
        body(begin, std::min(begin + kStretch, size), static_cast<std::size_t>(i));
    });
}

/// Summed in fixed stretches, these in order.
double dot(std::span<const float> a, std::span<const float> b) {
    std::vector<double> sums(a.size() / kStretch + 1);
    for_each_stretch(a.size(), [&](std::size_t begin, std::size_t end, std::size_t stretch) {
        double sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
        sums[stretch] = sum;
    });
    double sum = 0;
    for (const double part : sums) sum += part;
    return sum;
}

/// to = a + scale * b
void combine(std::span<const float> a, double scale, std::span<const float> b,
             std::span<float> to) {
    const auto s = static_cast<float>(scale);
    for_each_stretch(a.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end; ++i) to[i] = a[i] + s * b[i];
    });
}

/// Solves M x = d.
class ConjugateGradients {
  public:
    explicit ConjugateGradients(MatchOperator& problem)
        : problem_(problem),
          residual_(problem.voxels()),
          direction_(problem.voxels()),
          image_(problem.voxels()) {}

    void solve(std::span<const float> d, const MatchAdmmOptions& options,
               const std::function<bool()>& progress, std::span<float> x) {
        problem_.normal(x, image_);
        combine(d, -1, image_, residual_);
        direction_ = residual_;
        double size = dot(residual_, residual_);
        const double tolerance = static_cast<double>(options.cg_tolerance);
        const double small_enough = tolerance * tolerance * dot(d, d);
        for (int i = 0; i < options.cg_iterations && size > small_enough && progress(); ++i) {
            problem_.normal(direction_, image_);
            const double curvature = dot(direction_, image_);
            if (!(curvature > 0)) return;
            combine(x, size / curvature, direction_, x);
            combine(residual_, -size / curvature, image_, residual_);
            const double next_size = dot(residual_, residual_);
            combine(residual_, next_size / size, direction_, direction_);
            size = next_size;
        }
    }

  private:
    MatchOperator& problem_;
    std::vector<float> residual_;
    std::vector<float> direction_;
    std::vector<float> image_;
};

}  // namespace

void minimise_by_admm(MatchOperator& problem, const MatchAdmmOptions& options,
                      const AfterAdmmIteration& after_iteration,
                      const std::function<bool()>& progress, std::span<float> x) {
    const float threshold = 1 / options.rho;
    std::vector<float> v(problem.rows());
    std::vector<float> d(problem.voxels());
    ConjugateGradients inverse(problem);
    problem.start_duals(x, v);
    for (int i = 0; i < options.iterations; ++i) {
        problem.right_side(v, threshold, d);
        inverse.solve(d, options, progress, x);
        if (!progress()) return;
        if (!after_iteration(i, problem.update_duals(x, threshold, v))) return;
    }
}

}  // namespace stipple
