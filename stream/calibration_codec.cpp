#include "stream/header_codec.h"

#include <fmt/format.h>

#include "core/error.h"
#include "stream/little_endian.h"

namespace stipple {
namespace {

constexpr double kMaxDark = 1e12;
constexpr double kMinRelative = 1e-6;
constexpr double kMaxRelative = 1e6;

/// The first thing that is wrong with the calibration, or nothing.
std::string problem_of(double dark_e_per_slot) {
    if (dark_e_per_slot >= 0 && dark_e_per_slot <= kMaxDark) return {};
    return fmt::format("dark electrons per slot {:.12g} are outside 0..{:.12g}", dark_e_per_slot,
                       kMaxDark);
}

std::string problem_of(const CalibrationPixel& pixel) {
    for (const double value : {pixel.responsivity, pixel.conversion_gain})
        if (!(value >= kMinRelative && value <= kMaxRelative))
            return fmt::format("relative responsivity or gain {:.12g} is outside {:.12g}..{:.12g}",
                               value, kMinRelative, kMaxRelative);
    return {};
}

std::string problem_of(const CalibrationTile& tile) {
    const bool sized = tile.rows > 0 && tile.rows <= UINT16_MAX && tile.cols > 0 &&
                       tile.cols <= UINT16_MAX &&
                       static_cast<std::size_t>(tile.rows) * static_cast<std::size_t>(tile.cols) <=
                           kMaxCalibrationPixels;
    if (sized || (tile.rows == 0 && tile.cols == 0)) return {};
    return fmt::format("calibration tile of {} x {} pixels; at most {}, or 0 x 0 for none",
                       tile.rows, tile.cols, kMaxCalibrationPixels);
}

void check(const Calibration& calibration, std::string_view where) {
    const CalibrationTile& tile = calibration.tile;
    std::string problem = problem_of(calibration.dark_e_per_slot);
    if (problem.empty()) problem = problem_of(tile);
    if (problem.empty() && tile.pixels.size() != static_cast<std::size_t>(tile.rows) *
                                                     static_cast<std::size_t>(tile.cols))
        problem = "calibration tile and its pixels do not match";
    for (std::size_t i = 0; problem.empty() && i < tile.pixels.size(); ++i)
        problem = problem_of(tile.pixels[i]);
    if (!problem.empty()) throw InputError(where, problem);
}

}  // namespace

bool needs_calibration_section(const Calibration& calibration) {
    return calibration.dark_e_per_slot != 0 || calibration.tile != CalibrationTile{};
}

std::vector<std::uint8_t> encode_calibration(const Calibration& calibration,
                                             std::string_view where) {
    check(calibration, where);
    std::vector<std::uint8_t> bytes;
    append(bytes, calibration.dark_e_per_slot);
    append(bytes, static_cast<std::uint16_t>(calibration.tile.rows));
    append(bytes, static_cast<std::uint16_t>(calibration.tile.cols));
    for (const CalibrationPixel& pixel : calibration.tile.pixels) {
        append(bytes, pixel.responsivity);
        append(bytes, pixel.conversion_gain);
    }
    return bytes;
}

void decode_calibration(std::span<const std::uint8_t> section, std::size_t offset,
                        std::string_view where, Calibration& calibration) {
    ByteCursor cursor(section, offset, where);
    const auto require_good = [&](const std::string& problem) {
        if (!problem.empty()) cursor.fail(problem);
    };
    calibration.dark_e_per_slot = cursor.take<double>();
    require_good(problem_of(calibration.dark_e_per_slot));
    CalibrationTile& tile = calibration.tile;
    tile.rows = cursor.take<std::uint16_t>();
    tile.cols = cursor.take<std::uint16_t>();
    require_good(problem_of(tile));
    const auto pixels = static_cast<std::size_t>(tile.rows) * static_cast<std::size_t>(tile.cols);
    if (cursor.left() != pixels * 2 * sizeof(double))
        cursor.fail(fmt::format("calibration tile of {} x {} pixels does not fill its section",
                                tile.rows, tile.cols));
    tile.pixels.reserve(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const auto responsivity = cursor.take<double>();
        tile.pixels.push_back({responsivity, cursor.take<double>()});
        require_good(problem_of(tile.pixels.back()));
    }
    if (!needs_calibration_section(calibration)) cursor.fail("calibration section says nothing");
}

}  // namespace stipple
