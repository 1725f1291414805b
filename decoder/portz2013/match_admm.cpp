#include "decoder/portz2013/match_operator.h"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <limits>
#include <vector>

namespace stipple {
namespace {

class NormalMatrix;

}  // namespace
}  // namespace stipple

// NOLINTBEGIN(readability-identifier-naming): what Eigen asks of a matrix without elements
template <>
struct Eigen::internal::traits<stipple::NormalMatrix>
    : Eigen::internal::traits<Eigen::SparseMatrix<double>> {};

namespace stipple {
namespace {

/// M = K^T K as Eigen multiplies with it: in float, the sums of the solver are in double.
class NormalMatrix : public Eigen::EigenBase<NormalMatrix> {
  public:
    using Scalar = double;
    using RealScalar = double;
    using StorageIndex = int;
    enum {
        ColsAtCompileTime = Eigen::Dynamic,
        MaxColsAtCompileTime = Eigen::Dynamic,
        IsRowMajor = 0
    };

    NormalMatrix(MatchOperator& problem, const std::function<bool()>& progress)
        : problem_(problem), progress_(progress), x_(cols()), image_(cols()) {}

    [[nodiscard]] Eigen::Index rows() const { return cols(); }
    [[nodiscard]] Eigen::Index cols() const { return static_cast<Eigen::Index>(problem_.voxels()); }
    template <typename X>
    Eigen::Product<NormalMatrix, X, Eigen::AliasFreeProduct> operator*(
        const Eigen::MatrixBase<X>& x) const {
        return {*this, x.derived()};
    }

    /// Once false, always.
    bool keep_going() const {
        going_ = going_ && progress_();
        return going_;
    }
    /// to += scale M x. Once told to stop, M is the identity: the solver ends soon, its result is
    /// not used.
    void add_image(const Eigen::VectorXd& x, double scale, Eigen::VectorXd& to) const {
        if (!keep_going()) {
            to += scale * x;
            return;
        }
        x_ = x.cast<float>();
        problem_.normal({x_.data(), problem_.voxels()}, {image_.data(), problem_.voxels()});
        to += scale * image_.cast<double>();
    }

  private:
    MatchOperator& problem_;
    const std::function<bool()>& progress_;
    mutable Eigen::VectorXf x_;
    mutable Eigen::VectorXf image_;
    mutable bool going_ = true;
};

}  // namespace
}  // namespace stipple

template <>
struct Eigen::internal::generic_product_impl<stipple::NormalMatrix, Eigen::VectorXd,
                                             Eigen::SparseShape, Eigen::DenseShape,
                                             Eigen::GemvProduct>
    : Eigen::internal::generic_product_impl_base<
          stipple::NormalMatrix, Eigen::VectorXd,
          Eigen::internal::generic_product_impl<stipple::NormalMatrix, Eigen::VectorXd>> {
    static void scaleAndAddTo(Eigen::VectorXd& to, const stipple::NormalMatrix& m,
                              const Eigen::VectorXd& x, double scale) {
        m.add_image(x, scale, to);
    }
};
// NOLINTEND(readability-identifier-naming)

namespace stipple {

void minimise_by_admm(MatchOperator& problem, const MatchAdmmOptions& options,
                      const AfterAdmmIteration& after_iteration,
                      const std::function<bool()>& progress, std::span<float> x) {
    const NormalMatrix m(problem, progress);
    Eigen::ConjugateGradient<NormalMatrix, Eigen::Lower | Eigen::Upper,
                             Eigen::IdentityPreconditioner>
        inverse(m);
    inverse.setMaxIterations(options.cg_iterations);
    // A smaller residual is the rounding of M x.
    constexpr float kRounding = std::numeric_limits<float>::epsilon();
    inverse.setTolerance(static_cast<double>(std::max(options.cg_tolerance, kRounding)));
    const float threshold = 1 / options.rho;
    std::vector<float> v(problem.rows());
    Eigen::VectorXf d(m.cols());
    Eigen::Map<Eigen::VectorXf> light(x.data(), m.cols());
    problem.start_duals(x, v);
    for (int i = 0; i < options.iterations; ++i) {
        problem.right_hand_side(v, threshold, {d.data(), problem.voxels()});
        const Eigen::VectorXd solution =
            inverse.solveWithGuess(d.cast<double>(), light.cast<double>());
        if (!m.keep_going()) return;
        light = solution.cast<float>();
        if (!after_iteration(i, problem.update_duals(x, threshold, v))) return;
    }
}

}  // namespace stipple
