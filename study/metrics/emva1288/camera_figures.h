#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/emva1288_figures.h"
#include "study/metrics/emva1288/deviation_histogram.h"
#include "study/metrics/emva1288/high_pass.h"
#include "study/metrics/emva1288/image_statistics.h"
#include "study/metrics/emva1288/series.h"

namespace stipple::emva1288 {

/// One exposure of the photon transfer curve.
struct TransferPoint {
    double photons = 0;
    double mean_dn = 0;       ///< minus that of the dark images of the same exposure time
    double variance_dn2 = 0;  ///< temporal, minus that of the dark images
};

struct Evaluation {
    CameraFigures figures;
    std::vector<TransferPoint> transfer;  ///< by photons
    std::size_t saturation = 0;           ///< index of the point with the largest variance
    double dark_mean_dn = 0;
    double dark_variance_dn2 = 0;
    /// Fraction of the values of the dark stack that are 0. If it is large, the black level clips
    /// the noise, and all figures are biased.
    double dark_zero_fraction = 0;
    DeviationHistogram dark_deviations;    ///< of the mean dark image, DN
    DeviationHistogram bright_deviations;  ///< of bright - dark, after the high-pass, by its mean
};

/// Statistics of one group of images, and the fraction of its values that are 0.
struct GroupStatistics {
    std::size_t count = 0;  ///< of images
    ImageStatistics images;
    SpatialVariances split = {};  ///< of stacks of more than two images, with 3 rows and columns
    double zero_fraction = 0;
    /// Of stacks: spatial variance without shading. NaN for images smaller than 5 x 5.
    double high_pass_dn2 = std::numeric_limits<double>::quiet_NaN();
    PixelMap mean_image = {};  ///< of stacks, DN
};

/// Evaluates a series; `statistics` has the statistics of its groups in their order.
/// \throws InputError at `where` if the series does not have the necessary images: ten bright pairs
/// with dark images of their exposure times, at least five of them below 70 % of saturation, signal
/// that increases with light, and one stack of more than two images each, bright and dark.
[[nodiscard]] Evaluation evaluate(const Series& series,
                                  const std::vector<GroupStatistics>& statistics,
                                  const std::string& where);

/// Whether the black level is too low, so that the dark noise is cut off and all figures are
/// biased.
[[nodiscard]] bool is_biased(const Evaluation& evaluation);

/// How the figures are biased; empty if they are not.
[[nodiscard]] std::string bias_warning(const Evaluation& evaluation);

/// What surprises in the measured figures, also beside configured ones, though it follows from the
/// definitions of the standard; a sentence each.
[[nodiscard]] std::vector<std::string> figure_notes(const CameraFigures& measured,
                                                    const std::optional<CameraFigures>& configured);

}  // namespace stipple::emva1288
