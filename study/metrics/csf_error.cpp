#include "study/metrics/perceptual.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numeric>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace stipple {
namespace {

using Spectrum = std::vector<std::complex<double>>;

double mannos_sakrison(double cycles_per_degree) {
    const double u = 0.114 * cycles_per_degree;
    return 2.6 * (0.0192 + u) * std::exp(-std::pow(u, 1.1));
}

/// Eigen transforms no single number, which is its own transform.
Spectrum transform(const Spectrum& values) {
    if (values.size() == 1) return values;
    Spectrum spectrum(values.size());
    Eigen::FFT<double>().fwd(spectrum.data(), values.data(),
                             static_cast<Eigen::Index>(values.size()));
    return spectrum;
}

/// Without the bins above the half, which are the conjugates of the others.
Spectrum transform_row(std::span<const float> row) {
    if (row.size() == 1) return {static_cast<double>(row[0])};
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    const std::vector<double> values(row.begin(), row.end());
    Spectrum spectrum(values.size() / 2 + 1);
    fft.fwd(spectrum.data(), values.data(), static_cast<Eigen::Index>(values.size()));
    return spectrum;
}

}  // namespace

double contrast_sensitivity(double x_cycles_per_degree, double y_cycles_per_degree) noexcept {
    constexpr double kPeak = 7.8909;  // cycles per degree
    constexpr double kSymmetry = 0.7;
    const double angle = std::atan2(y_cycles_per_degree, x_cycles_per_degree);
    const double stretch = (1 - kSymmetry) / 2 * std::cos(4 * angle) + (1 + kSymmetry) / 2;
    const double f = std::hypot(x_cycles_per_degree, y_cycles_per_degree) / stretch;
    return f <= kPeak ? 1 : mannos_sakrison(f) / mannos_sakrison(kPeak);
}

CsfError::CsfError(FrameShape shape, double pixels_per_degree)
    : rows_(shape.rows), cols_(shape.cols) {
    if (!(pixels_per_degree > 0 && std::isfinite(pixels_per_degree)))
        throw InputError("pixels_per_degree",
                         fmt::format("{} is not finite and above 0", pixels_per_degree));
    const auto rows = static_cast<std::size_t>(rows_);
    const int bins = cols_ / 2 + 1;
    squared_weights_.resize(rows * static_cast<std::size_t>(bins));
    parallel_for(0, bins, [&](int bin) {
        double* const weights = &squared_weights_[static_cast<std::size_t>(bin) * rows];
        for (int row = 0; row < rows_; ++row) {
            const int cycles = row <= rows_ / 2 ? row : row - rows_;  // per height
            const double weight =
                contrast_sensitivity(static_cast<double>(bin) / cols_ * pixels_per_degree,
                                     static_cast<double>(cycles) / rows_ * pixels_per_degree);
            weights[row] = weight * weight;
        }
    });
}

double CsfError::mean_square(std::span<const float> image) const {
    const auto rows = static_cast<std::size_t>(rows_);
    const auto cols = static_cast<std::size_t>(cols_);
    assert(image.size() == rows * cols);
    std::vector<Spectrum> of_rows(rows);
    parallel_for(0, rows_, [&](int row) {
        const auto r = static_cast<std::size_t>(row);
        of_rows[r] = transform_row(image.subspan(r * cols, cols));
    });
    const std::size_t bins = cols / 2 + 1;
    std::vector<double> sums(bins);
    parallel_for(0, static_cast<int>(bins), [&](int bin) {
        const auto b = static_cast<std::size_t>(bin);
        Spectrum column(rows);
        for (std::size_t row = 0; row < rows; ++row) column[row] = of_rows[row][b];
        const Spectrum spectrum = transform(column);
        double sum = 0;
        for (std::size_t row = 0; row < rows; ++row)
            sum += squared_weights_[b * rows + row] * std::norm(spectrum[row]);
        const bool is_own_conjugate = b == 0 || 2 * b == cols;
        sums[b] = is_own_conjugate ? sum : 2 * sum;
    });
    const double pixels = static_cast<double>(rows_) * cols_;
    return std::accumulate(sums.begin(), sums.end(), 0.0) / (pixels * pixels);  // Parseval
}

}  // namespace stipple
