#include "study/metrics/emva1288/camera_figures.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>

#include "core/error.h"

namespace stipple::emva1288 {
namespace {

constexpr std::size_t kMinPairs = 10;
constexpr std::size_t kMinLinearPairs = 5;
constexpr double kLinearPart = 0.7;             ///< of saturation, for K and eta
constexpr double kRoundingVariance = 1.0 / 12;  ///< of a converter, DN^2
/// Part of the dark values that are 0 where the noise is cut off: Phi(-3).
constexpr double kCutOff = 0.00135;
constexpr double kMinTellingVariance = 0.24;  ///< DN^2; below, rounding hides the dark noise

using Statistics = std::vector<GroupStatistics>;

const ImageStatistics* dark_of(const Series& series, const Statistics& statistics,
                               const ImageGroup& bright) {
    for (std::size_t i = 0; i < series.groups.size(); ++i) {
        const ImageGroup& group = series.groups[i];
        if (group.dark && group.files.size() == 2 && group.exposure_ns == bright.exposure_ns)
            return &statistics[i].images;
    }
    return nullptr;
}

const GroupStatistics& stack_of(const Series& series, const Statistics& statistics, bool dark,
                                const std::string& where) {
    for (std::size_t i = 0; i < series.groups.size(); ++i)
        if (series.groups[i].dark == dark && series.groups[i].files.size() > 2)
            return statistics[i];
    throw InputError(where, fmt::format("has no stack of more than two {} images, which DSNU and "
                                        "PRNU need",
                                        dark ? "dark" : "bright"));
}

std::vector<TransferPoint> transfer_curve(const Series& series, const Statistics& statistics,
                                          const std::string& where) {
    std::vector<TransferPoint> points;
    for (std::size_t i = 0; i < series.groups.size(); ++i) {
        const ImageGroup& group = series.groups[i];
        if (group.dark || group.files.size() != 2) continue;
        const ImageStatistics* dark = dark_of(series, statistics, group);
        if (dark == nullptr)
            throw InputError(where, fmt::format("has no pair of dark images of {} ns, the exposure "
                                                "of bright ones",
                                                group.exposure_ns));
        const ImageStatistics& bright = statistics[i].images;
        points.push_back({group.photons, bright.mean_dn - dark->mean_dn,
                          bright.temporal_variance_dn2 - dark->temporal_variance_dn2});
    }
    std::ranges::stable_sort(points, {}, &TransferPoint::photons);
    if (points.size() < kMinPairs)
        throw InputError(where, fmt::format("has {} pairs of bright images; an evaluation takes {}",
                                            points.size(), kMinPairs));
    return points;
}

/// A figure of each point.
auto column(std::span<const TransferPoint> points, double TransferPoint::*figure) {
    constexpr int kFigures = sizeof(TransferPoint) / sizeof(double);
    using Column = Eigen::Map<const Eigen::ArrayXd, Eigen::Unaligned, Eigen::InnerStride<kFigures>>;
    return Column(&(points.front().*figure), std::ssize(points));
}

/// Slope of the least-squares line through the origin.
double slope(std::span<const TransferPoint> points, double TransferPoint::*x,
             double TransferPoint::*y) {
    return (column(points, x) * column(points, y)).sum() / column(points, x).square().sum();
}

/// LE: mean distance to the line that fits best relative to itself, 5 to 95 % of saturation.
double linearity_error(const std::vector<TransferPoint>& points, double saturation_dn) {
    std::vector<TransferPoint> used;
    std::ranges::copy_if(points, std::back_inserter(used), [&](const TransferPoint& point) {
        return point.mean_dn >= 0.05 * saturation_dn && point.mean_dn <= 0.95 * saturation_dn;
    });
    if (used.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    const Eigen::ArrayXd y = column(used, &TransferPoint::mean_dn);
    // a0 + a1 H = y, divided by y: the weights are 1 / y^2.
    Eigen::MatrixX2d line(y.size(), 2);
    line << y.inverse(), column(used, &TransferPoint::photons) / y;
    const Eigen::VectorXd fit =
        line * line.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(y.size()));
    return (fit.array().inverse() - 1).abs().mean();
}

/// The points up to 70 % of saturation. \throws InputError if they do not make a line.
std::span<const TransferPoint> linear_part(const Evaluation& evaluation, const std::string& where) {
    const auto& points = evaluation.transfer;
    if (points[evaluation.saturation].variance_dn2 <= 0)
        throw InputError(where, "more light does not give more noise, so it cannot tell electrons");
    const double max_dn = kLinearPart * points[evaluation.saturation].mean_dn;
    std::size_t count = 0;
    while (count < evaluation.saturation && points[count].mean_dn <= max_dn) ++count;
    if (count < kMinLinearPairs)
        throw InputError(where,
                         fmt::format("{} pairs of bright images are below 70 % of saturation (mean "
                                     "{:.4g} DN); an evaluation takes {}",
                                     count, max_dn / kLinearPart, kMinLinearPairs));
    return std::span(points).first(count);
}

double dark_noise_e(double dark_variance_dn2, double gain_dn_per_e) {
    const double telling = std::max(dark_variance_dn2, kMinTellingVariance);
    return std::sqrt(telling - kRoundingVariance) / gain_dn_per_e;
}

/// Standard deviation of a variance that a statistical error may have made negative.
double deviation(double variance) {
    return std::sqrt(std::max(variance, 0.0));
}

void set_non_uniformity(CameraFigures& f, const GroupStatistics& bright,
                        const GroupStatistics& dark) {
    const double k = f.gain_dn_per_e;
    const double signal = bright.images.mean_dn - dark.images.mean_dn;
    f.dsnu_e = deviation(dark.images.spatial_variance_dn2) / k;
    f.dsnu_row_e = deviation(dark.split.row_dn2) / k;
    f.dsnu_column_e = deviation(dark.split.column_dn2) / k;
    f.dsnu_pixel_e = deviation(dark.split.pixel_dn2) / k;
    f.dsnu_high_pass_e = deviation(dark.high_pass_dn2) / k;
    f.prnu_high_pass = deviation(bright.high_pass_dn2 - dark.high_pass_dn2) / signal;
    f.prnu =
        deviation(bright.images.spatial_variance_dn2 - dark.images.spatial_variance_dn2) / signal;
    f.prnu_row = deviation(bright.split.row_dn2 - dark.split.row_dn2) / signal;
    f.prnu_column = deviation(bright.split.column_dn2 - dark.split.column_dn2) / signal;
    f.prnu_pixel = deviation(bright.split.pixel_dn2 - dark.split.pixel_dn2) / signal;
}

void set_figures(Evaluation& evaluation, const GroupStatistics& bright, const GroupStatistics& dark,
                 const std::string& where) {
    const auto linear = linear_part(evaluation, where);
    const TransferPoint& saturation = evaluation.transfer[evaluation.saturation];
    const double k = slope(linear, &TransferPoint::mean_dn, &TransferPoint::variance_dn2);
    const double responsivity = slope(linear, &TransferPoint::photons, &TransferPoint::mean_dn);
    if (!(k > 0 && responsivity > 0 && std::isfinite(k) && std::isfinite(responsivity) &&
          bright.images.mean_dn > dark.images.mean_dn))
        throw InputError(where, "more light does not give more signal and more noise");
    CameraFigures& f = evaluation.figures;
    f.gain_dn_per_e = k;
    f.quantum_efficiency = responsivity / k;
    f.dark_noise_e = dark_noise_e(evaluation.dark_variance_dn2, k);
    f.saturation_e = f.quantum_efficiency * saturation.photons;
    set_non_uniformity(f, bright, dark);
    f.snr_max = std::sqrt(f.saturation_e);
    const double noise2_e2 = f.dark_noise_e * f.dark_noise_e + kRoundingVariance / (k * k);
    f.sensitivity_threshold_p = (std::sqrt(noise2_e2 + 0.25) + 0.5) / f.quantum_efficiency;
    f.dynamic_range = saturation.photons / f.sensitivity_threshold_p;
    f.linearity_error = linearity_error(evaluation.transfer, saturation.mean_dn);
}

/// The values of the mean of so many images lie on a grid of 1 / images, those of the high-pass on
/// one of 1 / 25 of that.
void set_deviations(Evaluation& evaluation, const GroupStatistics& bright,
                    const GroupStatistics& dark) {
    const auto grid_of = [](const GroupStatistics& group) {
        return 1 / static_cast<double>(group.count);
    };
    if (dark.mean_image.values.empty() || bright.mean_image.values.empty()) return;
    evaluation.dark_deviations = deviation_histogram(dark.mean_image.values, grid_of(dark));
    const double signal = bright.images.mean_dn - dark.images.mean_dn;
    PixelMap difference = bright.mean_image;
    for (std::size_t i = 0; i < difference.values.size(); ++i)
        difference.values[i] = (difference.values[i] - dark.mean_image.values[i]) / signal;
    evaluation.bright_deviations = deviation_histogram(
        high_pass(difference).values, grid_of(bright) / (kHighPassSize * kHighPassSize * signal));
}

}  // namespace

Evaluation evaluate(const Series& series, const Statistics& statistics, const std::string& where) {
    Evaluation evaluation;
    evaluation.transfer = transfer_curve(series, statistics, where);
    const GroupStatistics& dark = stack_of(series, statistics, true, where);
    const GroupStatistics& bright = stack_of(series, statistics, false, where);
    evaluation.saturation = static_cast<std::size_t>(
        std::ranges::max_element(evaluation.transfer, {}, &TransferPoint::variance_dn2) -
        evaluation.transfer.begin());
    evaluation.dark_mean_dn = dark.images.mean_dn;
    evaluation.dark_variance_dn2 = dark.images.temporal_variance_dn2;
    evaluation.dark_zero_fraction = dark.zero_fraction;
    set_figures(evaluation, bright, dark, where);
    set_deviations(evaluation, bright, dark);
    return evaluation;
}

bool is_biased(const Evaluation& evaluation) {
    return evaluation.dark_zero_fraction > kCutOff;
}

std::string bias_warning(const Evaluation& evaluation) {
    if (!is_biased(evaluation)) return {};
    return fmt::format(
        "{:.1f} % of the dark values are 0: the black level is too low, so the converter cuts the "
        "dark noise off and the figures are biased (of normal noise around 0 it leaves the mean "
        "0.40 sigma and the deviation 0.58 sigma). A black level of 4 sigma is enough; the "
        "emulated sensor takes one in mode \"physical\"",
        100 * evaluation.dark_zero_fraction);
}

std::vector<std::string> figure_notes(const CameraFigures& measured,
                                      const std::optional<CameraFigures>& configured) {
    std::vector<std::string> notes;
    if (configured && measured.saturation_e < configured->saturation_e)
        notes.emplace_back(
            "Saturation is where the variance is largest, before the mean pixel is full: it is "
            "below the configured one by definition, and so are maximum SNR and dynamic range.");
    if (measured.dsnu_row_e > measured.dsnu_e || measured.prnu_row > measured.prnu)
        notes.emplace_back(
            "DSNU and PRNU of rows contain the row noise that the mean of the images keeps; those "
            "of all pixels are without it, and can be less.");
    if (!notes.empty()) notes.back() += " See docs/characterize.md.";
    return notes;
}

}  // namespace stipple::emva1288
