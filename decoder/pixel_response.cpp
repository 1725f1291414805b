#include "decoder/pixel_response.h"

#include <algorithm>
#include <cmath>

#include "core/exposure_schedule.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

constexpr double kSaturationSigmas = 5;

/// The calibration as if all pixels were this one.
Calibration calibration_of(const Calibration& whole, const CalibrationPixel& pixel) {
    return {.bit_depth = whole.bit_depth,
            .rounding = whole.rounding,
            .black_level_dn = whole.black_level_dn,
            .gain_e_per_dn = whole.gain_e_per_dn / pixel.conversion_gain,
            .read_noise_e = whole.read_noise_e,
            .full_well_e = whole.full_well_e,
            .electrons_per_unit = whole.electrons_per_unit * pixel.responsivity,
            .dark_e_per_slot = whole.dark_e_per_slot};
}

/// The same as if all sites were this one.
Calibration calibration_of(const Calibration& whole, const CalibrationPixel& pixel,
                           const SiteCalibration& site) {
    constexpr double kRoundingDn2 = 1.0 / 12;
    Calibration c = calibration_of(whole, pixel);
    const double read_dn2 = static_cast<double>(site.readout_noise_dn2) - kRoundingDn2;
    c.read_noise_e = std::sqrt(std::max(read_dn2, 0.0)) * c.gain_e_per_dn;
    c.electrons_per_unit *= static_cast<double>(site.gain);
    // The mean of rounded values: that of kFloor lies half a DN below the level that is rounded.
    c.black_level_dn =
        static_cast<double>(site.offset_dn) + (c.rounding == Rounding::kFloor ? 0.5 : 0.0);
    c.dark_e_per_slot = 0;
    return c;
}

/// The least linear DN that the full well or full scale may have clipped.
double saturation_dn(const Calibration& c, const ResponseCurve* curve) {
    const auto largest = static_cast<std::uint16_t>((1U << static_cast<unsigned>(c.bit_depth)) - 1);
    const double full_scale_dn = curve == nullptr ? largest : curve->linear_dn(largest);
    const double well_dn = c.full_well_e / c.gain_e_per_dn;
    const double slope = curve == nullptr ? 1 : curve->slope_where(c.black_level_dn + well_dn);
    const double read_dn = slope * c.read_noise_e / c.gain_e_per_dn;
    const double noise_dn = std::sqrt(read_dn * read_dn + slope * slope / 12);
    // Where noise is as large as the well nothing is known, but half of it is no clipped sample.
    const double clipped_dn = std::max(well_dn - kSaturationSigmas * noise_dn, well_dn / 2);
    return std::min(full_scale_dn, c.black_level_dn + clipped_dn);
}

}  // namespace

SampleNoise::SampleNoise(const Calibration& calibration)
    : per_unit_(static_cast<float>(1 / calibration.electrons_per_unit)),
      one_dn_(static_cast<float>(calibration.gain_e_per_dn / calibration.electrons_per_unit)),
      none_(calibration.noise_free) {
    const double read = calibration.read_noise_e / calibration.electrons_per_unit;
    const double quantum = calibration.gain_e_per_dn / calibration.electrons_per_unit;
    constant_ = static_cast<float>(read * read + quantum * quantum / 12);
}

PixelResponse::PixelResponse(const Calibration& whole, const CalibrationPixel& pixel)
    : noise_(calibration_of(whole, pixel)) {
    const Calibration c = calibration_of(whole, pixel);
    black_level_dn_ = c.black_level_dn - (c.rounding == Rounding::kFloor ? 0.5 : 0.0);
    unit_per_dn_ = c.gain_e_per_dn / c.electrons_per_unit;
    dark_per_slot_ = c.dark_e_per_slot / c.electrons_per_unit;
    saturation_dn_ = saturation_dn(c, nullptr);
    dark_variance_per_slot_ = static_cast<float>(dark_per_slot_ / c.electrons_per_unit);
}

PixelResponse::PixelResponse(const Calibration& whole, const CalibrationPixel& pixel,
                             const SiteCalibration& site, double slot_s, const ResponseCurve* curve)
    : PixelResponse(calibration_of(whole, pixel, site), CalibrationPixel{}) {
    if (curve != nullptr) {
        curve_ = curve;
        saturation_dn_ = saturation_dn(calibration_of(whole, pixel, site), curve);
    }
    const auto gain = static_cast<double>(site.gain);
    const double electrons_per_unit = whole.electrons_per_unit * pixel.responsivity * gain;
    dark_per_slot_ = static_cast<double>(site.dark_dn_per_s) * slot_s * unit_per_dn_;
    dark_variance_per_slot_ =
        static_cast<float>(std::max(dark_per_slot_, 0.0) / electrons_per_unit);
    const double unit2 = unit_per_dn_ * unit_per_dn_;
    offset_variance_ = static_cast<float>(static_cast<double>(site.offset_variance_dn2) * unit2);
    dark_rate_variance_ =
        static_cast<float>(static_cast<double>(site.dark_variance) * slot_s * slot_s * unit2);
    relative_gain_variance_ =
        static_cast<float>(static_cast<double>(site.gain_variance) / (gain * gain));
    defect_ = site.defect;
}

SiteResponses::SiteResponses(const StreamHeader& header)
    : SiteResponses(header, readout_values(header.calibration)) {}

SiteResponses::SiteResponses(const StreamHeader& header, const ReadoutValues& values)
    : header_(&header), pixels_(with_values(header.calibration, values)) {
    if (!header.response.linear_dn.empty()) curve_.emplace(header.response);
}

PixelResponse SiteResponses::at(int plane, int row, int col) const {
    const StreamHeader& header = *header_;
    if (header.sites.empty()) return pixels_.at(row, col);
    const FrameShape shape = header.shape;
    const SiteCalibration& site =
        header.sites[index(plane) * shape.pixels() + row_major(row, col, shape.cols)];
    const CalibrationTile& tile = header.calibration.tile;
    const CalibrationPixel pixel =
        tile.pixels.empty() ? CalibrationPixel{}
                            : tile.pixels[row_major(row % tile.rows, col % tile.cols, tile.cols)];
    return {header.calibration, pixel, site, header.slot_us * 1e-6, curve_ ? &*curve_ : nullptr};
}

PixelResponses::PixelResponses(const Calibration& calibration) {
    const CalibrationTile& tile = calibration.tile;
    if (tile.pixels.empty()) {
        responses_.emplace_back(calibration, CalibrationPixel{});
        return;
    }
    rows_ = tile.rows;
    cols_ = tile.cols;
    for (const CalibrationPixel& pixel : tile.pixels) responses_.emplace_back(calibration, pixel);
}

void SaturatedSamples::add(const SamplePacket& packet) {
    if (packet.dn.empty()) return;  // dropped
    const SchedulePart part = schedule_at(header_, packet.slot);
    if (part.first_slot != part_begin_) {
        part_begin_ = part.first_slot;
        responses_.emplace(header_, readout_values(calibration_at(header_, part_begin_)));
    }
    const std::int64_t slot = readout_slot(part, packet.slot);
    const std::uint16_t* dn = packet.dn.data();
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        for_each_readout(*part.schedule, slot, row, header_.shape.cols, [&](int col, int) {
            for (int plane = 0; plane < header_.shape.planes; ++plane)
                if (responses_->at(plane, row, col).saturated(*dn++)) ++saturated_;
        });
    zeros_ += static_cast<std::uint64_t>(std::ranges::count(packet.dn, 0));
    samples_ += packet.dn.size();
}

}  // namespace stipple
