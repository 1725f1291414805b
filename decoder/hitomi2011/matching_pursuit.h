#pragma once

#include <functional>
#include <span>
#include <vector>

namespace stipple {

/// The inner products of a signal y and atoms a_j, from which a pursuit codes y.
struct PursuitProblem {
    std::span<const float> correlations;  ///< a_j^T y
    std::span<const float> norms;         ///< ||a_j||^2
    double energy = 0;                    ///< ||y||^2
    /// a_i^T a_j of an atom i and all j; valid during the pursuit.
    std::function<std::span<const float>(int atom)> gram;
};

/// Where a pursuit ends.
struct PursuitLimits {
    int max_atoms = 0;
    double max_error = 0;  ///< ||y - sum_j w_j a_j||^2
};

/// y = sum of weights[i] times atom atoms[i].
struct SparseCode {
    std::vector<int> atoms;
    std::vector<float> weights;
};

/// Orthogonal matching pursuit (Pati, Rezaiifar, Krishnaprasad 1993) on inner products (Rubinstein,
/// Zibulevsky, Elad 2008): takes the atom with the largest correlation with the residual, over its
/// norm, and solves the least squares of all atoms taken. Left out are atoms that those taken
/// before explain but for 0.1 % of the energy, and atoms with less than 2 % of the largest energy.
[[nodiscard]] SparseCode pursue(const PursuitProblem& problem, const PursuitLimits& limits);

}  // namespace stipple
