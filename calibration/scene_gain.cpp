#include "calibration/scene_gain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "calibration/field_samples.h"
#include "calibration/shrinkage.h"
#include "core/colour_filter.h"
#include "core/error.h"
#include "core/exposure_schedule.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"

namespace stipple {
namespace {

/// Standard deviation of decoded light, relative to it: sets the weights of the samples only.
constexpr double kLightError = 0.1;
/// Gains farther from 1 are taken for this: the light was decoded wrongly.
constexpr double kMaxDeviations = 6;
constexpr double kUsedRange = 0.8;  ///< of the range of the samples
constexpr std::uint16_t kLargestDn = 65535;
/// Samples by which the variance of all sites counts beside the residuals of one.
constexpr double kPriorSamples = 4;
constexpr double kMinNoise = 1e-6;  ///< of that which the weights expect: samples may be exact
constexpr int kRadius = 3;          ///< pixels

/// The sites of a light group that the scene has shown: their gains and the variances of these.
struct Gains {
    std::vector<std::size_t> site;
    std::vector<double> gain;
    std::vector<double> variance;
};

/// Weighted squares of what the regression leaves of the samples.
double residuals(const SceneSums& sums) {
    return std::max(sums.sample2 - sums.light_sample * sums.light_sample / sums.light2, 0.0);
}

/// The gains of a group and their variances: by the residuals of each site's samples, and, as they
/// are few, by those of all sites.
Gains gains_of(const StreamHeader& header, std::span<const SceneSums> sums, std::size_t group) {
    Gains gains;
    std::vector<double> noise;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (light_group(header, i) != group || !(sums[i].light2 > 0)) continue;
        gains.site.push_back(i);
        gains.gain.push_back(sums[i].light_sample / sums[i].light2);
        if (sums[i].samples > 1) noise.push_back(residuals(sums[i]) / (sums[i].samples - 1));
    }
    const double typical = noise.empty() ? 1 : std::max(median(noise), kMinNoise);
    for (const std::size_t i : gains.site)
        gains.variance.push_back((residuals(sums[i]) + kPriorSamples * typical) /
                                 (sums[i].samples - 1 + kPriorSamples) / sums[i].light2);
    return gains;
}

/// The mean of the gains within kRadius pixels of each, weighted by their variances. The pattern of
/// a chip is white, errors of decoded light are not.
std::vector<double> local_means(const Gains& gains, FrameShape shape) {
    struct Weighted {
        double gain = 0;
        double weight = 0;
    };
    const int rows = shape.rows * shape.planes;  // a group lies within one plane
    std::vector<Weighted> at(shape.sites());
    for (std::size_t i = 0; i < gains.site.size(); ++i)
        at[gains.site[i]] = {gains.gain[i], 1 / gains.variance[i]};
    std::vector<double> means(gains.site.size());
    parallel_for(0, static_cast<int>(means.size()), [&](int number) {
        const auto [site_row, site_col] =
            std::div(static_cast<std::int64_t>(gains.site[index(number)]),
                     static_cast<std::int64_t>(shape.cols));
        const auto row = static_cast<int>(site_row), col = static_cast<int>(site_col);
        Weighted sum;
        for (int r = std::max(row - kRadius, 0); r <= std::min(row + kRadius, rows - 1); ++r)
            for (int c = std::max(col - kRadius, 0); c <= std::min(col + kRadius, shape.cols - 1);
                 ++c) {
                const Weighted& near = at[row_major(r, c, shape.cols)];
                sum.gain += near.weight * near.gain;
                sum.weight += near.weight;
            }
        means[index(number)] = sum.gain / sum.weight;
    });
    return means;
}

/// Shrinks the gains around their local means. Decoded light errs more than samples do, so the
/// variances are scaled to explain the scatter that `prnu` leaves.
void shrink(const Gains& gains, double prnu, FrameShape shape,
            std::vector<SiteCalibration>& sites) {
    std::vector<double> deviation = local_means(gains, shape);
    for (std::size_t i = 0; i < deviation.size(); ++i) deviation[i] = gains.gain[i] - deviation[i];
    const double scatter = robust_deviation(deviation);
    const double pattern = prnu * prnu;
    const double error = std::max(scatter * scatter - pattern, pattern / 5);
    const double scale = error / median(gains.variance);
    for (std::size_t i = 0; i < gains.site.size(); ++i) {
        const double variance = gains.variance[i] * scale;
        const double weight = pattern / (pattern + variance);
        const double bounded =
            std::clamp(deviation[i], -kMaxDeviations * prnu, kMaxDeviations * prnu);
        sites[gains.site[i]].gain = static_cast<float>(1 + weight * bounded);
    }
}

/// The calibration of a site by the header: equal pixels.
SiteCalibration equal_site(const StreamHeader& header) {
    const Calibration& c = header.calibration;
    const double noise_dn = c.read_noise_e / c.gain_e_per_dn;
    return {.gain = 1,
            .gain_variance = 0,
            .offset_dn = static_cast<float>(c.black_level_dn),
            .offset_variance_dn2 = 0,
            .dark_dn_per_s =
                static_cast<float>(c.dark_e_per_slot / c.gain_e_per_dn / (header.slot_us * 1e-6)),
            .dark_variance = 0,
            .readout_noise_dn2 = static_cast<float>(noise_dn * noise_dn + 1.0 / 12),
            .defect = false};
}

}  // namespace

SceneGain::SceneGain(const StreamHeader& header, const std::string& where)
    : header_(header),
      responses_(header),
      frame_shape_(decoded_shape(header)),
      frames_(index(std::max(header.schedule.longest_span_slots(), 1))),
      sums_(header.shape.sites()) {
    if (header.schedule.weighted())
        throw InputError(where, "has weighted exposures; gains of the pixels are part of weights");
    for (auto& frame : frames_) frame.resize(frame_shape_.sites());
}

void SceneGain::add_frame(std::span<const float> frame) {
    assert(frame.size() == frame_shape_.sites());
    std::ranges::copy(frame, frames_[index(slots_) % frames_.size()].begin());
    ++slots_;
}

/// Light of an exposure: the sum of the frames of its open slots.
float SceneGain::light_of(std::int64_t last_slot, std::uint64_t open_slots, int span_slots,
                          std::size_t voxel) const {
    float light = 0;
    for (int i = 0; i < span_slots; ++i)
        if ((open_slots >> static_cast<unsigned>(i) & 1U) != 0)
            light += frames_[index(last_slot - span_slots + 1 + i) % frames_.size()][voxel];
    return light;
}

void SceneGain::add_sample(std::size_t site, const PixelResponse& response, std::uint16_t dn,
                           int light_slots, double light) {
    // By the decoded light, not by the sample: else only the darker of noisy samples would count.
    const auto full = static_cast<double>(response.light(kLargestDn, light_slots));
    if (!(light > 0 && light < kUsedRange * full) || response.saturated(dn)) return;
    const double error = kLightError * light;
    const double weight =
        1 /
        (static_cast<double>(response.noise().variance(static_cast<float>(light))) + error * error);
    const auto sample = static_cast<double>(response.light(dn, light_slots));
    SceneSums& sums = sums_[site];
    ++sums.samples;
    sums.light_sample += weight * light * sample;
    sums.light2 += weight * light * light;
    sums.sample2 += weight * sample * sample;
}

void SceneGain::add_samples(const SamplePacket& packet) {
    assert(packet.slot == slots_ - 1);
    if (packet.dn.empty()) return;  // dropped
    const ExposureSchedule& schedule = header_.schedule;
    const FrameShape shape = header_.shape;
    const std::uint16_t* dn = packet.dn.data();
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        visit_due_pixels(schedule, packet.slot, row, shape.cols, [&](int col, const DuePixel& due) {
            const int tile_row = row % schedule.tile_rows(), tile_col = col % schedule.tile_cols();
            const std::size_t begun = exposure_starting_at(schedule, tile_row, tile_col,
                                                           packet.slot - due.span_slots + 1);
            const std::uint64_t open_slots =
                schedule.exposures(tile_row, tile_col)[begun].open_slots;
            const std::size_t pixel = row_major(row, col, shape.cols);
            for (int plane = 0; plane < shape.planes; ++plane) {
                const int colour = header_.cfa == ColourFilter::kNone
                                       ? plane
                                       : colour_plane(header_.cfa, row, col);
                const float light = light_of(packet.slot, open_slots, due.span_slots,
                                             index(colour) * shape.pixels() + pixel);
                add_sample(index(plane) * shape.pixels() + pixel, responses_.at(plane, row, col),
                           *dn++, due.light_slots, static_cast<double>(light));
            }
        });
}

ChipCalibration SceneGain::estimate(double prnu) const {
    assert(prnu > 0);
    ChipCalibration calibration{
        .shape = header_.shape,
        .cfa = header_.cfa,
        .bit_depth = header_.calibration.bit_depth,
        .tile_rows = header_.calibration.tile.rows,
        .tile_cols = header_.calibration.tile.cols,
        .chip = {},
        .sites = std::vector<SiteCalibration>(header_.shape.sites(), equal_site(header_))};
    for (std::size_t group = 0; group < kMaxLightGroups; ++group) {
        const Gains gains = gains_of(header_, sums_, group);
        if (!gains.site.empty()) shrink(gains, prnu, header_.shape, calibration.sites);
    }
    return calibration;
}

std::optional<ChipCalibration> scene_calibration(StreamReader& decoded, StreamReader& samples,
                                                 const DecodeOptions& options, double prnu,
                                                 const ProgressCallback& progress) {
    SceneGain gains(samples.header(), samples.name());
    SamplePacket packet;
    bool more = samples.next(packet);
    bool stopped = false;
    decode(
        decoded, options,
        [&](std::int64_t slot, std::span<const float> frame) {
            gains.add_frame(frame);
            for (; more && packet.slot <= slot; more = samples.next(packet))
                gains.add_samples(packet);
            return true;
        },
        [&](double slots) { return !(stopped = stopped || !progress(slots)); });
    if (stopped) return {};
    return gains.estimate(prnu);
}

}  // namespace stipple
