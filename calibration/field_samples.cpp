#include "calibration/field_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "calibration/shrinkage.h"
#include "core/colour_filter.h"
#include "core/exposure_schedule.h"
#include "core/index.h"

namespace stipple {

double ExposureSums::variance(std::size_t site) const {
    const double n = count[site];
    const auto all = static_cast<double>(sum[site]);
    return std::max(static_cast<double>(sum_of_squares[site]) - all * all / n, 0.0) / (n - 1);
}

double ExposureSums::row_error(int plane, FrameShape shape) const {
    const auto cols = index(shape.cols);
    double error = 0, measured = 0;
    for (std::size_t row = 0; row < index(shape.rows); ++row) {
        const std::size_t line = index(plane) * index(shape.rows) + row;
        const RowSums& frames = rows[line];
        const double n = frames.frames;
        if (n < 2 || cols < 2) continue;
        const double of_mean =
            std::max(frames.square_of_mean - frames.mean * frames.mean / n, 0.0) / (n - 1) / n;
        double of_site = 0;
        for (std::size_t site = line * cols; site < (line + 1) * cols; ++site)
            of_site += variance(site) / n / shape.cols;
        // A mean of C sites, each of variance v with e in common, has the variance e + (v - e) / C.
        error += (of_mean - of_site / shape.cols) * shape.cols / (shape.cols - 1);
        ++measured;
    }
    return measured > 0 ? std::max(error / measured, 0.0) : 0;
}

std::uint64_t FieldSamples::count(std::size_t site) const {
    std::uint64_t count = 0;
    for (const auto& [time, sums] : exposures_) count += sums.count[site];
    return count;
}

std::uint64_t FieldSamples::fewest() const {
    std::uint64_t fewest = UINT64_MAX;
    for (std::size_t site = 0; site < shape_.sites(); ++site)
        fewest = std::min(fewest, count(site));
    return fewest;
}

ExposureSums& FieldSamples::at(std::int64_t exposure_ns) {
    ExposureSums& sums = exposures_[exposure_ns];
    if (sums.count.empty()) {
        sums.count.resize(shape_.sites());
        sums.sum.resize(shape_.sites());
        sums.sum_of_squares.resize(shape_.sites());
        sums.rows.resize(index(shape_.planes) * index(shape_.rows));
    }
    return sums;
}

FieldCollector::FieldCollector(const StreamHeader& header, FieldSamples& field)
    : header_(header),
      field_(field),
      responses_(header),
      by_open_slots_(index(kMaxExposureSlots) + 1) {
    assert(header.shape == field.shape());
}

/// The samples of a whole row, planes of a pixel side by side.
void FieldCollector::add_row(int row, std::span<const std::uint16_t> dn, ExposureSums& sums) const {
    const auto planes = index(header_.shape.planes);
    for (std::size_t plane = 0; plane < planes; ++plane) {
        double mean = 0;
        for (std::size_t i = plane; i < dn.size(); i += planes) mean += dn[i];
        mean /= header_.shape.cols;
        RowSums& frames = sums.rows[plane * index(header_.shape.rows) + index(row)];
        ++frames.frames;
        frames.mean += mean;
        frames.square_of_mean += mean * mean;
    }
}

void FieldCollector::add(const SamplePacket& packet) {
    if (packet.dn.empty()) return;  // dropped
    const FrameShape shape = header_.shape;
    const std::uint16_t* dn = packet.dn.data();
    const auto take = [&](ExposureSums& sums, int plane, int row, int col) {
        const std::uint64_t value = *dn++;
        const std::size_t site = index(plane) * shape.pixels() + row_major(row, col, shape.cols);
        ++sums.count[site];
        sums.sum[site] += value;
        sums.sum_of_squares[site] += value * value;
        ++sums.samples;
        if (value == 0) ++sums.zeros;
        if (responses_.at(plane, row, col).saturated(static_cast<std::uint16_t>(value)))
            ++sums.saturated;
    };
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row) {
        const std::uint16_t* const begin = dn;
        ExposureSums* first = nullptr;
        int alike = 0;
        visit_due_pixels(
            header_.schedule, packet.slot, row, shape.cols, [&](int col, const DuePixel& due) {
                ExposureSums*& sums = by_open_slots_[due.light_slots];
                if (sums == nullptr)
                    sums = &field_.at(std::llround(header_.slot_us * 1000 * due.light_slots));
                if (first == nullptr) first = sums;
                if (sums == first) ++alike;
                for (int plane = 0; plane < shape.planes; ++plane) take(*sums, plane, row, col);
            });
        if (first != nullptr && alike == shape.cols) add_row(row, {begin, dn}, *first);
    }
}

std::size_t light_group(const StreamHeader& header, std::size_t site) {
    if (header.cfa == ColourFilter::kNone) return site / header.shape.pixels();
    const auto cols = index(header.shape.cols);
    return index(
        colour_plane(header.cfa, static_cast<int>(site / cols), static_cast<int>(site % cols)));
}

double FieldExposure::mean(std::size_t site) const {
    const double dn = sums->mean(site);
    return curve == nullptr ? dn : curve->linear_mean(dn);
}

double FieldExposure::variance(std::size_t site) const {
    const double dn2 = sums->variance(site);
    if (curve == nullptr) return dn2;
    const auto slope = static_cast<double>(
        curve->slope(static_cast<std::uint16_t>(std::lround(sums->mean(site)))));
    return slope * slope * dn2;
}

double FieldExposure::mean_variance(std::size_t site, std::size_t group) const {
    constexpr double kNoisy = 4;
    const double pooled = noise_dn2[group];
    const double own = sums->count[site] > 1 ? variance(site) : 0;
    return (own > kNoisy * pooled ? own : pooled) / sums->count[site];
}

FieldExposure linearised(FieldExposure exposure, const StreamHeader& header,
                         const ResponseCurve* curve) {
    constexpr double kRoundingDn2 = 1.0 / 12;
    const ExposureSums& sums = *exposure.sums;
    exposure.curve = curve;
    for (std::size_t group = 0; group < kMaxLightGroups; ++group) {
        EstimateMap means;
        std::vector<double> variances;
        for (std::size_t site = 0; site < sums.count.size(); ++site) {
            if (light_group(header, site) != group || sums.count[site] < 2) continue;
            means.value.push_back(exposure.mean(site));
            means.variance.push_back(0);
            variances.push_back(exposure.variance(site));
        }
        exposure.noise_dn2[group] = std::max(mean_of(variances, inliers(means)), kRoundingDn2);
    }
    const double mean_dn =
        std::accumulate(sums.sum.begin(), sums.sum.end(), 0.0) / static_cast<double>(sums.samples);
    const auto slope = static_cast<double>(
        curve == nullptr ? 1 : curve->slope(static_cast<std::uint16_t>(std::lround(mean_dn))));
    exposure.row_error_dn2.clear();
    for (int plane = 0; plane < header.shape.planes; ++plane)
        exposure.row_error_dn2.push_back(slope * slope * sums.row_error(plane, header.shape));
    return exposure;
}

FieldExposure field_exposure(std::int64_t exposure_ns, const ExposureSums& sums,
                             const StreamHeader& header) {
    return linearised({.seconds = 1e-9 * static_cast<double>(exposure_ns), .sums = &sums}, header,
                      nullptr);
}

}  // namespace stipple
