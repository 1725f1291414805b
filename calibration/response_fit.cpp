#include "calibration/response_fit.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

constexpr int kMaxDegree = 6;
constexpr std::size_t kMinLevels = 3;
constexpr double kPenalty = 2;   ///< of a parameter, in chi^2, by Mallows
constexpr double kCertain = 16;  ///< the same of a chip that is linear: four standard deviations

/// The functions (y - b) u^j, j = 1 .. J. Below b they are 0, above the brightest level straight.
class Basis {
  public:
    Basis(const DnRange& range, double brightest_dn)
        : black_dn_(range.black_dn),
          span_dn_(std::exp2(range.bit_depth) - 1 - range.black_dn),
          brightest_dn_(brightest_dn) {}

    [[nodiscard]] Eigen::RowVectorXd at(double dn, int degree) const {
        const double inside = std::min(dn, brightest_dn_) - black_dn_;
        Eigen::RowVectorXd values = Eigen::RowVectorXd::Zero(degree);
        if (inside <= 0) return values;
        const double u = inside / span_dn_, beyond = std::max(dn - brightest_dn_, 0.0);
        double power = 1;
        for (int j = 1; j <= degree; ++j) {
            power *= u;
            values[j - 1] = power * (inside + (j + 1) * beyond);
        }
        return values;
    }

  private:
    double black_dn_;
    double span_dn_;
    double brightest_dn_;
};

/// The levels that count, with the columns of their scales.
struct Equations {
    std::vector<ResponseLevel> levels;
    std::map<std::size_t, int> columns;   ///< of each scale
    std::map<std::size_t, double> units;  ///< largest exposure of each scale
    std::size_t most = 0;                 ///< levels of one scale
};

struct Solution {
    int degree = 0;
    Eigen::VectorXd coefficients;
    Eigen::MatrixXd covariance;  ///< without the factor that chi^2 gives
    double chi2 = 0;
    double freedom = 0;  ///< degrees of freedom
};

Equations equations_of(std::span<const ResponseLevel> levels) {
    std::map<std::size_t, std::size_t> counts;
    for (const ResponseLevel& level : levels) ++counts[level.scale];
    Equations equations;
    for (const ResponseLevel& level : levels) {
        if (counts[level.scale] < 2) continue;
        equations.levels.push_back(level);
        equations.columns.try_emplace(level.scale, static_cast<int>(equations.columns.size()));
        double& unit = equations.units[level.scale];
        unit = std::max(unit, level.exposure);
        equations.most = std::max(equations.most, counts[level.scale]);
    }
    return equations;
}

Solution solve(const Equations& equations, const Basis& basis, int degree) {
    const auto rows = static_cast<Eigen::Index>(equations.levels.size());
    const auto cols = degree + static_cast<Eigen::Index>(equations.columns.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(rows, cols);
    Eigen::VectorXd right(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
        const ResponseLevel& level = equations.levels[static_cast<std::size_t>(row)];
        const double weight = 1 / std::sqrt(level.variance_dn2);
        matrix.row(row).head(degree) =
            weight * (basis.at(level.mean_dn, degree) - basis.at(level.dark_dn, degree));
        matrix(row, degree + equations.columns.at(level.scale)) =
            -weight * level.exposure / equations.units.at(level.scale);
        right[row] = -weight * (level.mean_dn - level.dark_dn);
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
    const Eigen::VectorXd solution = qr.solve(right);
    const Eigen::MatrixXd inverse =
        qr.colsPermutation() * Eigen::MatrixXd(qr.matrixR()
                                                   .topLeftCorner(cols, cols)
                                                   .triangularView<Eigen::Upper>()
                                                   .solve(Eigen::MatrixXd::Identity(cols, cols)));
    return {.degree = degree,
            .coefficients = solution.head(degree),
            .covariance = (inverse * inverse.transpose()).topLeftCorner(degree, degree),
            .chi2 = (matrix * solution - right).squaredNorm(),
            .freedom = static_cast<double>(rows - cols)};
}

double linear_dn(const Solution& solution, const Basis& basis, double dn) {
    return dn + basis.at(dn, solution.degree).dot(solution.coefficients);
}

double scale_of(const Solution& solution) {
    return std::max(1.0, solution.chi2 / solution.freedom);
}

double variance_of(const Solution& solution, const Basis& basis, double dn) {
    const Eigen::RowVectorXd values = basis.at(dn, solution.degree);
    return std::max(values.dot(solution.covariance * values.transpose()) * scale_of(solution), 0.0);
}

ResponseTable table_of(const Solution& solution, const Basis& basis, int bit_depth) {
    ResponseTable table;
    for (int dn = 0; dn < 1 << bit_depth; ++dn) {
        table.linear_dn.push_back(static_cast<float>(linear_dn(solution, basis, dn)));
        table.variance_dn2.push_back(static_cast<float>(variance_of(solution, basis, dn)));
    }
    return table;
}

bool rises(const ResponseTable& table) {
    return std::ranges::adjacent_find(table.linear_dn, std::greater_equal<>()) ==
           table.linear_dn.end();
}

/// The fit of the degree that the levels justify.
Solution best_fit(const Equations& equations, const Basis& basis, int bit_depth) {
    const int free = static_cast<int>(equations.levels.size() - equations.columns.size());
    std::vector<Solution> solutions;
    for (int degree = 0; degree <= std::min(kMaxDegree, free - 1); ++degree) {
        Solution solution = solve(equations, basis, degree);
        if (rises(table_of(solution, basis, bit_depth))) solutions.push_back(std::move(solution));
    }
    const double scale = scale_of(solutions.back());
    const auto score = [scale](double penalty) {
        return [scale, penalty](const Solution& solution) {
            return solution.chi2 / scale + penalty * solution.degree;
        };
    };
    const Solution& best = *std::ranges::min_element(solutions, {}, score(kPenalty));
    const bool bends = score(kCertain)(best) < score(kCertain)(solutions.front());
    return bends ? best : solutions.front();
}

/// \throws InputError if the samples of a scale fall. Precondition: sorted by scale and exposure.
void require_rise(std::span<const ResponseLevel> levels, std::string_view where) {
    constexpr double kSigmas = 5;
    const auto fall = std::ranges::adjacent_find(
        levels, [](const ResponseLevel& darker, const ResponseLevel& brighter) {
            return darker.scale == brighter.scale && darker.exposure < brighter.exposure &&
                   darker.mean_dn - brighter.mean_dn >
                       kSigmas * std::sqrt(darker.variance_dn2 + brighter.variance_dn2);
        });
    if (fall == levels.end()) return;
    throw InputError(
        where,
        fmt::format("falls from {:.6g} to {:.6g} DN while light x time rises by {:.3g} %, so it "
                    "tells no response curve; the light must be constant and the samples below "
                    "saturation",
                    fall->mean_dn, std::next(fall)->mean_dn,
                    100 * (std::next(fall)->exposure / fall->exposure - 1)));
}

}  // namespace

ResponseFit fit_response(std::span<const ResponseLevel> levels, const DnRange& range,
                         std::string_view where) {
    std::vector<ResponseLevel> sorted(levels.begin(), levels.end());
    std::ranges::sort(sorted, {}, [](const ResponseLevel& level) {
        return std::pair(level.scale, level.exposure);
    });
    require_rise(sorted, where);
    const Equations equations = equations_of(sorted);
    if (equations.most < kMinLevels) return {};
    const double brightest =
        std::ranges::max_element(equations.levels, {}, &ResponseLevel::mean_dn)->mean_dn;
    const Basis basis(range, brightest);
    const Solution solution = best_fit(equations, basis, range.bit_depth);
    ResponseFit fit{.levels = equations.levels.size(), .brightest_dn = brightest};
    if (solution.degree == 0) return fit;
    fit.table = table_of(solution, basis, range.bit_depth);
    fit.bend_dn = linear_dn(solution, basis, brightest) - brightest;
    fit.error_dn = std::sqrt(variance_of(solution, basis, brightest));
    return fit;
}

}  // namespace stipple
