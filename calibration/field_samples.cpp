#include "calibration/field_samples.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/exposure_schedule.h"
#include "core/index.h"

namespace stipple {

double ExposureSums::variance(std::size_t site) const {
    const double n = count[site];
    const auto all = static_cast<double>(sum[site]);
    return std::max(static_cast<double>(sum_of_squares[site]) - all * all / n, 0.0) / (n - 1);
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
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        visit_due_pixels(
            header_.schedule, packet.slot, row, shape.cols, [&](int col, const DuePixel& due) {
                ExposureSums*& sums = by_open_slots_[due.light_slots];
                if (sums == nullptr)
                    sums = &field_.at(std::llround(header_.slot_us * 1000 * due.light_slots));
                for (int plane = 0; plane < shape.planes; ++plane) take(*sums, plane, row, col);
            });
}

}  // namespace stipple
