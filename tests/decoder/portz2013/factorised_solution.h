#pragma once

#include <span>
#include <vector>

namespace stipple {

struct FactorisedSolution {
    std::vector<double> x;
    double least_eigenvalue = 0;  ///< of the matrix
};

/// Solves M x = d by the LDL^T factorisation of a symmetric matrix, row by row.
[[nodiscard]] FactorisedSolution solve_factorised(std::span<const double> matrix,
                                                  std::span<const double> d);

}  // namespace stipple
