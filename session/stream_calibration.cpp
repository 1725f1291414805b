#include "session/stream_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/calibration_file.h"
#include "core/error.h"
#include "readout/provenance.h"

namespace stipple {
namespace fs = std::filesystem;

CalibrationChoice calibration_choice(const fs::path& text) {
    if (text.empty()) return {};
    return text == "none" ? fs::path() : text;
}

fs::path calibration_file(const fs::path& stream, const CalibrationChoice& choice) {
    return choice ? *choice : calibration_beside(stream);
}

ChipCalibration read_calibration(const fs::path& file, const StreamHeader& header) {
    ChipCalibration calibration = read_chip_calibration(file);
    const ChipOrigin chip = chip_of(header.provenance);
    require_same_chip(calibration, header, {.name = chip.name, .device_id = chip.device_id},
                      file.string());
    return calibration;
}

Message calibrate(StreamReader& stream, const CalibrationChoice& choice) {
    const fs::path file = calibration_file(stream.name(), choice);
    if (file.empty()) return fixed_pattern_warning(stream.name(), stream.header());
    try {
        ChipCalibration calibration = read_calibration(file, stream.header());
        stream.use_sites(std::move(calibration.sites), std::move(calibration.response));
    } catch (const InputError& error) {
        if (choice) throw;
        throw InputError(stream.name(), "the calibration beside it cannot be used (" +
                                            Message(Parameter{"calibration", "none"}) +
                                            " decodes without): " + error.message());
    }
    return {};
}

Message fixed_pattern_warning(const std::string& stream, const StreamHeader& header) {
    constexpr double kMinDb = 0.1;
    const ChipOrigin chip = chip_of(header.provenance);
    const Calibration& c = header.calibration;
    const double full_scale_e = c.gain_e_per_dn * (std::exp2(c.bit_depth) - 1 - c.black_level_dn);
    const double half_e = std::min(c.full_well_e, full_scale_e) / 2;
    const double pattern_e2 = chip.prnu * chip.prnu * half_e * half_e + chip.dsnu_e * chip.dsnu_e +
                              chip.column_noise_e * chip.column_noise_e;
    const double cost_db =
        10 * std::log10(1 + pattern_e2 / (half_e + c.read_noise_e * c.read_noise_e));
    const Parameter calibration{"calibration"};
    Message text;
    if (cost_db >= kMinDb) {
        text += fmt::format(
            "{}: the pixels of this chip differ (PRNU {:.2g} %, offsets {:.2g} e); without ",
            stream, 100 * chip.prnu, std::hypot(chip.dsnu_e, chip.column_noise_e));
        text += calibration;
        text += fmt::format(
            " a sample at half of saturation loses {:.1f} dB of its SNR (stipple calibrate)",
            cost_db);
    }
    if (chip.response_loss > 0) {
        text += fmt::format("{}{}: the response of this chip is non-linear; without ",
                            text.empty() ? "" : "\n", stream);
        text += calibration;
        text += fmt::format(" bright light decodes up to {:.2g} % too dark (stipple calibrate)",
                            100 * chip.response_loss);
    }
    return text;
}

}  // namespace stipple
