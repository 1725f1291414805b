#include "decoder/hitomi2011/matching_pursuit.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "core/index.h"

namespace stipple {
namespace {

/// An atom of which the others leave a smaller part of its energy would amplify noise.
constexpr double kMinOwnEnergy = 1e-3;

/// So would an atom that the samples see less of, in parts of the energy of the one seen best.
constexpr float kMinSeenEnergy = 0.02F;

/// The state of a pursuit.
class Pursuit {
  public:
    explicit Pursuit(const PursuitProblem& problem)
        : problem_(problem),
          correlations_(problem.correlations.begin(), problem.correlations.end()),
          usable_(problem.norms.size()) {
        const float largest = problem.norms.empty() ? 0 : *std::ranges::max_element(problem.norms);
        for (std::size_t j = 0; j < usable_.size(); ++j)
            usable_[j] = problem.norms[j] > kMinSeenEnergy * largest ? 1 : 0;
    }

    /// Takes one more atom; false if none is left.
    bool take_atom() {
        for (;;) {
            const int atom = best_atom();
            if (atom < 0) return false;
            usable_[index(atom)] = 0;
            if (add(atom)) return true;
        }
    }

    [[nodiscard]] double error() const { return error_; }
    [[nodiscard]] int taken() const { return static_cast<int>(atoms_.size()); }
    [[nodiscard]] SparseCode code() const {
        SparseCode code{.atoms = atoms_, .weights = {}};
        for (const double weight : weights_) code.weights.push_back(static_cast<float>(weight));
        return code;
    }

  private:
    /// The first of those with the largest correlation over its norm; -1: none.
    [[nodiscard]] int best_atom() const {
        int best = -1;
        float most = 0;
        for (std::size_t j = 0; j < usable_.size(); ++j) {
            if (usable_[j] == 0) continue;
            const float gain = correlations_[j] * correlations_[j] / problem_.norms[j];
            if (gain > most) {
                most = gain;
                best = static_cast<int>(j);
            }
        }
        return best;
    }

    /// False if the atoms taken explain this one.
    bool add(int atom) {
        const auto row = problem_.gram(atom);
        const auto n = static_cast<Eigen::Index>(atoms_.size()) + 1;
        gram_.conservativeResize(n, n);
        for (Eigen::Index i = 0; i + 1 < n; ++i)
            gram_(n - 1, i) = static_cast<double>(row[index(atoms_[index(i)])]);
        gram_(n - 1, n - 1) = static_cast<double>(problem_.norms[index(atom)]);
        const Eigen::LLT<Eigen::MatrixXd> factor(gram_);  // of the lower triangle
        const double own = factor.matrixLLT()(n - 1, n - 1);
        if (factor.info() != Eigen::Success || own * own < kMinOwnEnergy * gram_(n - 1, n - 1)) {
            gram_.conservativeResize(n - 1, n - 1);
            return false;
        }
        atoms_.push_back(atom);
        rows_.push_back(row);
        Eigen::VectorXd right(n);
        for (Eigen::Index i = 0; i < n; ++i)
            right[i] = static_cast<double>(problem_.correlations[index(atoms_[index(i)])]);
        weights_ = factor.solve(right);
        error_ = problem_.energy - weights_.dot(right);
        update_correlations();
        return true;
    }

    void update_correlations() {
        std::ranges::copy(problem_.correlations, correlations_.begin());
        for (std::size_t i = 0; i < atoms_.size(); ++i) {
            const auto weight = static_cast<float>(weights_[static_cast<Eigen::Index>(i)]);
            const std::span<const float> row = rows_[i];
            for (std::size_t j = 0; j < row.size(); ++j) correlations_[j] -= weight * row[j];
        }
    }

    const PursuitProblem& problem_;
    std::vector<float> correlations_;  ///< with the residual
    std::vector<char> usable_;
    std::vector<int> atoms_;
    std::vector<std::span<const float>> rows_;  ///< of the Gram matrix, of each atom taken
    Eigen::MatrixXd gram_;                      ///< of the atoms taken
    Eigen::VectorXd weights_;
    double error_ = 0;
};

}  // namespace

SparseCode pursue(const PursuitProblem& problem, const PursuitLimits& limits) {
    Pursuit pursuit(problem);
    double error = problem.energy;
    while (pursuit.taken() < limits.max_atoms && error > limits.max_error) {
        if (!pursuit.take_atom()) break;
        error = pursuit.error();
    }
    return pursuit.code();
}

}  // namespace stipple
