#include "calibration/chip_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

/// How two chips differ; empty if they do not, as far as is known.
std::string difference(const ChipIdentity& ours, const ChipIdentity& theirs) {
    if (!ours.name.empty() && !theirs.name.empty() && ours.name != theirs.name)
        return fmt::format("the sensor \"{}\", and the stream of \"{}\"", terminal_text(ours.name),
                           terminal_text(theirs.name));
    if (ours.device_id && theirs.device_id && *ours.device_id != *theirs.device_id)
        return fmt::format("the chip with device_id {}, and the stream of {}", *ours.device_id,
                           *theirs.device_id);
    return {};
}

MapFigures map_figures(const ChipCalibration& calibration, float SiteCalibration::*number) {
    const auto sum = [&](auto term) {
        double total = 0;
        for (const SiteCalibration& site : calibration.sites)
            if (!site.defect) total += term(static_cast<double>(site.*number));
        return total;
    };
    const double count = sum([](double) { return 1; });
    const double mean = sum([](double value) { return value; }) / count;
    const double squares = sum([mean](double value) { return (value - mean) * (value - mean); });
    return {mean, std::sqrt(squares / count)};
}

}  // namespace

ChipFigures chip_figures(const ChipCalibration& calibration) {
    return {.gain = map_figures(calibration, &SiteCalibration::gain),
            .gain_error = std::sqrt(map_figures(calibration, &SiteCalibration::gain_variance).mean),
            .offset_dn = map_figures(calibration, &SiteCalibration::offset_dn),
            .dark_dn_per_s = map_figures(calibration, &SiteCalibration::dark_dn_per_s),
            .readout_noise_dn2 = map_figures(calibration, &SiteCalibration::readout_noise_dn2),
            .defects = static_cast<std::size_t>(
                std::ranges::count_if(calibration.sites, &SiteCalibration::defect))};
}

void require_same_chip(const ChipCalibration& calibration, const StreamHeader& header,
                       const ChipIdentity& chip, std::string_view where) {
    const auto require = [&](bool same, const std::string& what, const std::string& streams) {
        if (!same)
            throw InputError(where, fmt::format("is the calibration of {}, and the stream has {}; "
                                                "calibrate the chip of the stream",
                                                what, streams));
    };
    const FrameShape ours = calibration.shape;
    const FrameShape theirs = header.shape;
    require(
        ours == theirs,
        fmt::format("{} x {} pixels in {}", ours.cols, ours.rows, counted(ours.planes, "plane")),
        fmt::format("{} x {} in {}", theirs.cols, theirs.rows, theirs.planes));
    require(calibration.cfa == header.cfa, "another colour filter array", "its own");
    require(calibration.bit_depth == header.calibration.bit_depth,
            fmt::format("samples of {} bits", calibration.bit_depth),
            fmt::format("{} bits", header.calibration.bit_depth));
    const CalibrationTile& tile = header.calibration.tile;
    require(calibration.tile_rows == tile.rows && calibration.tile_cols == tile.cols,
            fmt::format("a tile of {} x {} unequal pixels", calibration.tile_rows,
                        calibration.tile_cols),
            fmt::format("one of {} x {}", tile.rows, tile.cols));
    const std::string other = difference(calibration.chip, chip);
    if (!other.empty())
        throw InputError(where, fmt::format("is the calibration of {}; calibrate the chip of the "
                                            "stream",
                                            other));
}

}  // namespace stipple
