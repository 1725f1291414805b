#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "stream/stream_header.h"

namespace stipple {

/// What a calibration belongs to, as far as it is known.
struct ChipIdentity {
    std::string name;                             ///< of the sensor; empty: unknown
    std::optional<std::uint32_t> device_id = {};  ///< which chip of this sensor

    bool operator==(const ChipIdentity&) const = default;
};

/// Calibration of all sites of one chip (docs/calibration.md).
struct ChipCalibration {
    FrameShape shape;
    ColourFilter cfa = ColourFilter::kNone;
    int bit_depth = 8;  ///< of the DN that offset, dark current and noise are given in
    /// Size of the tile of unequal pixels that gains are relative to; 0 x 0: none.
    int tile_rows = 0;
    int tile_cols = 0;
    ChipIdentity chip;
    std::uint32_t flats = 0;  ///< samples of uniform light at the site that has the fewest
    std::uint32_t darks = 0;  ///< the same without light
    std::vector<SiteCalibration> sites;  ///< order (plane, row, col)
    ResponseTable response = {};         ///< of all sites; empty: linear

    bool operator==(const ChipCalibration&) const = default;
};

/// Of a number over the sites without defect. NaN without such sites.
struct MapFigures {
    double mean = 0;
    double deviation = 0;  ///< standard deviation
};

/// Figures of the maps as they are stored. They scatter less than the pattern of the chip: noise of
/// their measurement is shrunk away, and what it hides with it.
struct ChipFigures {
    MapFigures gain;
    double gain_error = 0;  ///< root mean square of the standard deviations of the gains
    MapFigures offset_dn;
    MapFigures dark_dn_per_s;
    MapFigures readout_noise_dn2;
    std::size_t defects = 0;
};

[[nodiscard]] ChipFigures chip_figures(const ChipCalibration& calibration);

/// \throws InputError at `where` if the calibration cannot be that of the chip of a stream: another
/// size, colour filter array, bit depth or tile of unequal pixels, or another `chip`, where both
/// are known.
void require_same_chip(const ChipCalibration& calibration, const StreamHeader& header,
                       const ChipIdentity& chip, std::string_view where);

}  // namespace stipple
