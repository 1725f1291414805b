#include "tests/decoder/portz2013/factorised_solution.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace stipple {

FactorisedSolution solve_factorised(std::span<const double> matrix, std::span<const double> d) {
    const auto size = std::ssize(d);
    const Eigen::MatrixXd m = Eigen::Map<const Eigen::MatrixXd>(matrix.data(), size, size);
    const Eigen::LDLT<Eigen::MatrixXd> factors(m);
    EXPECT_EQ(factors.info(), Eigen::Success);
    FactorisedSolution solution{std::vector<double>(d.size())};
    Eigen::Map<Eigen::VectorXd>(solution.x.data(), size) =
        factors.solve(Eigen::Map<const Eigen::VectorXd>(d.data(), size));
    solution.least_eigenvalue =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues()[0];
    return solution;
}

}  // namespace stipple
