#include "apps/fixed_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/calibration_file.h"
#include "readout/provenance.h"

namespace stipple {

ChipCalibration read_calibration(const std::string& file, const StreamHeader& header) {
    ChipCalibration calibration = read_chip_calibration(file);
    const ChipOrigin chip = chip_of(header.provenance);
    require_same_chip(calibration, header, {.name = chip.name, .device_id = chip.device_id}, file);
    return calibration;
}

std::string fixed_pattern_warning(const std::string& stream, const StreamHeader& header) {
    constexpr double kMinDb = 0.1;
    const ChipOrigin chip = chip_of(header.provenance);
    const Calibration& c = header.calibration;
    const double full_scale_e = c.gain_e_per_dn * (std::exp2(c.bit_depth) - 1 - c.black_level_dn);
    const double half_e = std::min(c.full_well_e, full_scale_e) / 2;
    const double pattern_e2 = chip.prnu * chip.prnu * half_e * half_e + chip.dsnu_e * chip.dsnu_e +
                              chip.column_noise_e * chip.column_noise_e;
    const double cost_db =
        10 * std::log10(1 + pattern_e2 / (half_e + c.read_noise_e * c.read_noise_e));
    std::string text;
    if (cost_db >= kMinDb)
        text = fmt::format(
            "{}: the pixels of this chip differ (PRNU {:.2g} %, offsets {:.2g} e); without "
            "--calibration a sample at half of saturation loses {:.1f} dB of its SNR (stipple "
            "calibrate)",
            stream, 100 * chip.prnu, std::hypot(chip.dsnu_e, chip.column_noise_e), cost_db);
    if (chip.response_loss > 0)
        text += fmt::format(
            "{}{}: the response of this chip is non-linear; without --calibration bright light "
            "decodes up to {:.2g} % too dark (stipple calibrate)",
            text.empty() ? "" : "\n", stream, 100 * chip.response_loss);
    return text;
}

}  // namespace stipple
