#include "study/metrics/video_quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>

#include "core/error.h"
#include "core/light.h"
#include "core/parallel.h"
#include "study/metrics/perceptual.h"

namespace stipple {
namespace {

double square(double value) {
    return value * value;
}

double psnr(double peak, double mean_square) {
    return 10 * std::log10(square(peak) / mean_square);
}

float gamma_encoded(float light) {
    return std::pow(std::clamp(light, 0.0F, 1.0F), 1 / 2.2F);
}

}  // namespace

auto QualityMeter::SquaredErrors::operator+=(const SquaredErrors& other) -> SquaredErrors& {
    linear += other.linear;
    gamma += other.gamma;
    pu21 += other.pu21;
    return *this;
}

QualityMeter::QualityMeter(FrameShape shape, const QualityOptions& options)
    : shape_(shape),
      options_(options),
      result_gamma_(shape.sites()),
      reference_gamma_(shape.sites()) {
    if (shape.rows < 1 || shape.cols < 1 || shape.planes < 1)
        throw InputError("quality", "the frames are empty");
    if (options.margin < 0)
        throw InputError("margin", fmt::format("{} is negative", options.margin));
    if (options.max_value && !(static_cast<float>(*options.max_value) > 0))
        throw InputError("max_value", fmt::format("{} is not above 0", *options.max_value));
    if (!(options.peak > 0 && std::isfinite(options.peak)))
        throw InputError("peak", fmt::format("{} is not finite and above 0", options.peak));
    if (!(options.unit_cd_per_m2 > 0 && std::isfinite(options.unit_cd_per_m2)))
        throw InputError("unit_cd_per_m2",
                         fmt::format("{} is not finite and above 0", options.unit_cd_per_m2));
    if (options.pixels_per_degree) csf_.emplace(shape, *options.pixels_per_degree);
}

QualityMeter::SquaredErrors QualityMeter::add_row(std::span<const float> result,
                                                  std::span<const float> reference, int row) {
    const auto max_light = static_cast<float>(
        options_.max_value.value_or(static_cast<double>(std::numeric_limits<float>::max())));
    const auto width = static_cast<std::size_t>(shape_.cols);
    const std::size_t begin = static_cast<std::size_t>(row) * width;
    SquaredErrors sum;
    for (std::size_t i = begin; i < begin + width; ++i) {
        const float a = std::min(result[i], max_light);
        const float b = std::min(reference[i], max_light);
        result_gamma_[i] = gamma_encoded(a);
        reference_gamma_[i] = gamma_encoded(b);
        const auto x = static_cast<double>(a);
        const auto y = static_cast<double>(b);
        sum += {square(x - y),
                square(static_cast<double>(result_gamma_[i]) -
                       static_cast<double>(reference_gamma_[i])),
                square(pu21(x * options_.unit_cd_per_m2) - pu21(y * options_.unit_cd_per_m2))};
    }
    return sum;
}

void QualityMeter::add(std::span<const float> result, std::span<const float> reference) {
    assert(result.size() == shape_.sites() && reference.size() == shape_.sites());
    const int rows = shape_.planes * shape_.rows;
    std::vector<SquaredErrors> row_errors(static_cast<std::size_t>(rows));
    parallel_for(0, rows, [&](int row) {
        row_errors[static_cast<std::size_t>(row)] = add_row(result, reference, row);
    });
    FrameQuality frame;
    for (const SquaredErrors& errors : row_errors) frame.errors += errors;
    for (int plane = 0; plane < shape_.planes; ++plane) {
        const std::size_t offset = static_cast<std::size_t>(plane) * shape_.pixels();
        frame.ssim += ssim({result_gamma_.data() + offset, shape_.rows, shape_.cols},
                           {reference_gamma_.data() + offset, shape_.rows, shape_.cols});
    }
    if (options_.pu21_ssim || csf_) add_luminance(result, reference, frame);
    frames_.push_back(frame);
}

std::vector<float> QualityMeter::pu21_luminance(std::span<const float> light) const {
    const std::size_t pixels = shape_.pixels();
    const auto max_light = static_cast<float>(
        options_.max_value.value_or(static_cast<double>(std::numeric_limits<float>::max())));
    std::vector<float> clipped(light.begin(), light.end());
    for (float& value : clipped) value = std::min(value, max_light);
    std::vector<float> luminance(pixels);
    if (shape_.planes == 3)
        reduce_to_luminance(clipped, luminance);
    else
        luminance.assign(clipped.begin(), clipped.begin() + static_cast<std::ptrdiff_t>(pixels));
    const auto cols = static_cast<std::size_t>(shape_.cols);
    parallel_for(0, shape_.rows, [&](int row) {
        for (float& value :
             std::span(luminance).subspan(static_cast<std::size_t>(row) * cols, cols))
            value = static_cast<float>(pu21(static_cast<double>(value) * options_.unit_cd_per_m2));
    });
    return luminance;
}

void QualityMeter::add_luminance(std::span<const float> result, std::span<const float> reference,
                                 FrameQuality& frame) const {
    constexpr float kPu21Range = 256;
    std::vector<float> a = pu21_luminance(result);
    std::vector<float> b = pu21_luminance(reference);
    if (csf_) {
        std::vector<float> error(a.size());
        std::ranges::transform(a, b, error.begin(), std::minus<>());
        frame.csf_mean_square = csf_->mean_square(error);
    }
    if (!options_.pu21_ssim) return;
    for (float& value : a) value /= kPu21Range;
    for (float& value : b) value /= kPu21Range;
    frame.pu21_ssim =
        ssim({a.data(), shape_.rows, shape_.cols}, {b.data(), shape_.rows, shape_.cols});
}

auto QualityMeter::counted() const -> std::span<const FrameQuality> {
    const auto margin = static_cast<std::size_t>(options_.margin);
    if (frames_.size() <= 2 * margin)
        throw InputError("margin",
                         fmt::format("leaving out {} frames at each end leaves none of {}", margin,
                                     frames_.size()));
    return std::span(frames_).subspan(margin, frames_.size() - 2 * margin);
}

VideoQuality QualityMeter::quality_of(std::span<const FrameQuality> counted) const {
    const auto frames = static_cast<double>(counted.size());
    const auto sites = static_cast<double>(shape_.sites());
    SquaredErrors errors;
    VideoQuality quality;
    double pu21_ssim = 0;
    double csf_mean_square = 0;
    for (const FrameQuality& frame : counted) {
        errors += frame.errors;
        quality.psnr_frame_mean_db += psnr(options_.peak, frame.errors.linear / sites) / frames;
        quality.ssim += frame.ssim / (frames * shape_.planes);
        pu21_ssim += frame.pu21_ssim / frames;
        csf_mean_square += frame.csf_mean_square / frames;
    }
    const double pu21_peak = pu21(options_.peak * options_.unit_cd_per_m2);
    quality.psnr_db = psnr(options_.peak, errors.linear / (frames * sites));
    quality.psnr_gamma_db = psnr(1, errors.gamma / (frames * sites));
    quality.pu21_psnr_db = psnr(pu21_peak, errors.pu21 / (frames * sites));
    if (options_.pu21_ssim) quality.pu21_ssim = pu21_ssim;
    if (csf_) quality.pu21_csf_psnr_db = psnr(pu21_peak, csf_mean_square);
    return quality;
}

VideoQuality QualityMeter::quality() const {
    return quality_of(counted());
}

std::vector<VideoQuality> QualityMeter::frame_qualities() const {
    const auto frames = counted();
    std::vector<VideoQuality> qualities;
    for (std::size_t i = 0; i < frames.size(); ++i)
        qualities.push_back(quality_of(frames.subspan(i, 1)));
    return qualities;
}

VideoQuality QualityMeter::last_quality() const {
    return quality_of(std::span(frames_).last(1));
}

}  // namespace stipple
