#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace stipple {

/// What a trial costs and how good it is (docs/explore.md). NaN: there is no such figure.
struct TrialFigures {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    double slots_per_second = kNone;
    std::string limited_by;  ///< "slot", or the part of the readout that limits the rate
    double readout_slots_per_second = kNone;  ///< what the readout allows, with timing
    double megabits_per_second = kNone;
    double code_megabits_per_second = kNone;  ///< of coded sensors; others have 0
    double energy_uj_per_slot = kNone;        ///< of sensors with timing
    double light_throughput = kNone;          ///< of one aperture
    double field_of_view = kNone;             ///< fraction of the pixels of the clip that is seen
    double samples_per_voxel = kNone;         ///< of all sensors
    double psnr_db = kNone;
    double psnr_gamma_db = kNone;
    double pu21_psnr_db = kNone;
    double sample_range_stops = kNone;
    double decode_seconds = kNone;
    std::string compared_slots = {};  ///< "A:B", those before B
};

/// A column of text of the table.
struct TextColumn {
    std::string_view name;
    std::string TrialFigures::*value;
};

inline constexpr std::array<TextColumn, 2> kTextColumns{
    {{"limited_by", &TrialFigures::limited_by}, {"compared_slots", &TrialFigures::compared_slots}}};

enum class Better : std::uint8_t { kMore, kLess };

/// A column of numbers of the table.
struct FigureColumn {
    std::string_view name;
    std::string_view title;  ///< for people, with the unit
    double TrialFigures::*value;
    Better better;
};

inline constexpr std::array<FigureColumn, 13> kFigureColumns{
    {{"slots_per_second", "slot rate, 1/s", &TrialFigures::slots_per_second, Better::kMore},
     {"readout_slots_per_second", "slot rate of the readout, 1/s",
      &TrialFigures::readout_slots_per_second, Better::kMore},
     {"megabits_per_second", "data rate, Mbit/s", &TrialFigures::megabits_per_second,
      Better::kLess},
     {"code_megabits_per_second", "exposure code, Mbit/s", &TrialFigures::code_megabits_per_second,
      Better::kLess},
     {"energy_uj_per_slot", "energy per slot, uJ", &TrialFigures::energy_uj_per_slot,
      Better::kLess},
     {"light_throughput", "light throughput", &TrialFigures::light_throughput, Better::kMore},
     {"field_of_view", "field of view", &TrialFigures::field_of_view, Better::kMore},
     {"samples_per_voxel", "samples per voxel", &TrialFigures::samples_per_voxel, Better::kLess},
     {"psnr_db", "PSNR, dB", &TrialFigures::psnr_db, Better::kMore},
     {"psnr_gamma_db", "PSNR after 1/2.2, dB", &TrialFigures::psnr_gamma_db, Better::kMore},
     {"pu21_psnr_db", "PU21-PSNR, dB", &TrialFigures::pu21_psnr_db, Better::kMore},
     {"sample_range_stops", "sample range, stops", &TrialFigures::sample_range_stops,
      Better::kMore},
     {"decode_seconds", "decode time, s", &TrialFigures::decode_seconds, Better::kLess}}};

}  // namespace stipple
