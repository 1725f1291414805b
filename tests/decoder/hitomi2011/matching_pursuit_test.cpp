#include "decoder/hitomi2011/matching_pursuit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "core/index.h"

namespace stipple {
namespace {

/// A problem of its own: atoms are the columns.
struct Atoms {
    Eigen::MatrixXf matrix;
    Eigen::VectorXf signal;
    Eigen::VectorXf correlations = matrix.transpose() * signal;
    Eigen::VectorXf norms = matrix.colwise().squaredNorm();
    Eigen::MatrixXf gram = matrix.transpose() * matrix;

    [[nodiscard]] SparseCode code(const PursuitLimits& limits) const {
        const auto span = [](const auto& v) { return std::span(v.data(), index(v.size())); };
        return pursue({.correlations = span(correlations),
                       .norms = span(norms),
                       .energy = static_cast<double>(signal.squaredNorm()),
                       .gram = [&](int j) -> std::span<const float> {
                           return {gram.col(j).data(), index(gram.rows())};
                       }},
                      limits);
    }
    [[nodiscard]] double error(const SparseCode& code) const {
        Eigen::VectorXf rest = signal;
        for (std::size_t k = 0; k < code.atoms.size(); ++k)
            rest -= code.weights[k] * matrix.col(code.atoms[k]);
        return static_cast<double>(rest.squaredNorm());
    }
};

Eigen::MatrixXf random_matrix(int rows, int cols, std::uint32_t seed) {
    std::mt19937 random(seed);
    Eigen::MatrixXf m(rows, cols);
    for (int col = 0; col < cols; ++col)
        for (int row = 0; row < rows; ++row)
            m(row, col) = static_cast<float>(random() >> 8U) * 0x1p-23F - 1;
    return m;
}

// Incoherent atoms of different norms, twice as many as values: the sum of 5 is found.
TEST(MatchingPursuitTest, FindsASparseSum) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        Eigen::MatrixXf m = random_matrix(60, 120, seed);
        for (int j = 0; j < 120; ++j) m.col(j) *= static_cast<float>(1 + j % 4);
        const std::vector<int> chosen{3, 17, 60, 90, 119};
        Eigen::VectorXf y = Eigen::VectorXf::Zero(60);
        for (const int j : chosen) y += (j % 2 == 0 ? -0.5F : 1.0F) * m.col(j).normalized();
        SparseCode code = Atoms{m, y}.code({.max_atoms = 20, .max_error = 1e-5});
        ASSERT_EQ(code.atoms.size(), 5U) << seed;
        for (std::size_t k = 0; k < 5; ++k) {
            const int j = code.atoms[k];
            EXPECT_TRUE(std::ranges::find(chosen, j) != chosen.end()) << j;
            EXPECT_NEAR(code.weights[k] * m.col(j).norm(), j % 2 == 0 ? -0.5F : 1.0F, 1e-4F);
        }
    }
}

TEST(MatchingPursuitTest, TheErrorFallsWithEachAtomToTheLeastSquares) {
    const Atoms atoms{random_matrix(12, 40, 4), random_matrix(12, 1, 5)};
    double before = static_cast<double>(atoms.signal.squaredNorm());
    for (int n = 1; n <= 12; ++n) {
        const SparseCode code = atoms.code({.max_atoms = n});
        ASSERT_EQ(code.atoms.size(), static_cast<std::size_t>(n));
        const double error = atoms.error(code);
        EXPECT_LT(error, before);
        before = error;
    }
    EXPECT_LT(before, 1e-6) << "12 atoms span all signals";
}

TEST(MatchingPursuitTest, EndsAtItsLimits) {
    const Atoms atoms{random_matrix(30, 60, 6), random_matrix(30, 1, 7)};
    const double energy = static_cast<double>(atoms.signal.squaredNorm());
    const SparseCode code = atoms.code({.max_atoms = 30, .max_error = 0.3 * energy});
    EXPECT_LE(atoms.error(code), 0.3 * energy);
    SparseCode fewer = atoms.code({.max_atoms = static_cast<int>(code.atoms.size()) - 1});
    EXPECT_GT(atoms.error(fewer), 0.3 * energy);
    EXPECT_TRUE(atoms.code({.max_atoms = 30, .max_error = energy}).atoms.empty());
}

// Twice the same atom, and one of 0: least squares of both would have no solution.
TEST(MatchingPursuitTest, DependentAtomsAreLeftOut) {
    const auto code = [](const Eigen::Vector3f& signal) {
        Eigen::MatrixXf m = Eigen::MatrixXf::Zero(3, 4);
        m.row(0) << 1, 2, 0, 1;
        m(1, 3) = 1;
        return Atoms{std::move(m), signal}.code({.max_atoms = 4});
    };
    const SparseCode two = code({3, 1, 1});
    ASSERT_EQ(two.atoms, (std::vector<int>{0, 3}));
    EXPECT_NEAR(two.weights[0], 2, 1e-6F);
    EXPECT_NEAR(two.weights[1], 1, 1e-6F);
    EXPECT_TRUE(code({0, 0, 1}).atoms.empty());
}

}  // namespace
}  // namespace stipple
