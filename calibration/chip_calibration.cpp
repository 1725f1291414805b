#include "calibration/chip_calibration.h"

#include <fmt/format.h>

#include "core/error.h"
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

}  // namespace

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
    require(ours == theirs,
            fmt::format("{} x {} pixels in {} planes", ours.cols, ours.rows, ours.planes),
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
