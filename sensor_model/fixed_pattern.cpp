#include "sensor_model/fixed_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/parallel.h"
#include "core/philox.h"
#include "sensor_model/normal.h"

namespace stipple {
namespace {

constexpr std::uint64_t kPatternKey = 0;  ///< not the seed: the pattern outlives a run

double factor(double spread, std::uint32_t word) {
    return std::max(0.0, 1 + spread * static_cast<double>(normal_one(word)));
}

/// Value of a map of the tile.
double at(const std::vector<double>& map, const PhysicalTerms& terms, int row, int col) {
    if (map.empty()) return 1;
    return map[index(row % terms.map_rows) * index(terms.map_cols) + index(col % terms.map_cols)];
}

/// The traits that do not depend on the place, and how they vary.
struct Chip {
    explicit Chip(const SensorParams& params)
        : terms(params.physical),
          responsivity_e(params.electrons_per_unit()),
          dark_e(params.dark_e_per_slot()),
          hot_e(dark_e_with(params, terms.hot_pixel_dark_current)),
          read_noise_e(params.read_noise_e) {}

    static double dark_e_with(SensorParams params, double dark_current_e_per_s) {
        params.physical.dark_current_e_per_s = dark_current_e_per_s;
        return params.dark_e_per_slot();
    }

    [[nodiscard]] SiteParams site(const PhiloxCounter& words) const {
        const double u = (static_cast<double>(words[3]) + 0.5) * 0x1p-32;
        if (u < terms.dead_pixel_fraction) return {};
        const double s = terms.read_noise_spread;
        const double read = read_noise_e * factor(s, words[2]) / std::sqrt(1 + s * s);
        const bool hot = u > 1 - terms.hot_pixel_fraction;
        return {.responsivity_e = static_cast<float>(responsivity_e * factor(terms.prnu, words[0])),
                .dark_e_per_slot = static_cast<float>(hot ? dark_e + hot_e : dark_e),
                .offset_e =
                    static_cast<float>(terms.dsnu_e * static_cast<double>(normal_one(words[1]))),
                .read_noise_e = static_cast<float>(
                    std::sqrt(read * read + terms.reset_noise_e * terms.reset_noise_e)),
                .gain = 1};
    }

    PhysicalTerms terms;
    double responsivity_e;
    double dark_e;
    double hot_e;
    double read_noise_e;
};

std::vector<float> column_offsets(const PhysicalTerms& terms, int cols, std::uint32_t plane) {
    std::vector<float> offsets(index(cols));
    for (std::size_t col = 0; col < offsets.size(); ++col) {
        const auto words =
            philox4x32(random_address(static_cast<std::uint32_t>(col), terms.device_id,
                                      RandomPurpose::kColumnPattern, plane),
                       kPatternKey);
        offsets[col] =
            static_cast<float>(terms.column_noise_e * static_cast<double>(normal_one(words[0])));
    }
    return offsets;
}

}  // namespace

FixedPattern::FixedPattern(const SensorParams& params, FrameShape shape)
    : pixels_(shape.pixels()), sites_(shape.sites()) {
    const Chip chip(params);
    for (std::uint32_t plane = 0; plane < static_cast<std::uint32_t>(shape.planes); ++plane) {
        const auto columns = column_offsets(chip.terms, shape.cols, plane);
        parallel_for(0, shape.rows, [&](int row) {
            for (int col = 0; col < shape.cols; ++col) {
                const std::size_t pixel = row_major(row, col, shape.cols);
                SiteParams site = chip.site(philox4x32(
                    random_address(static_cast<std::uint32_t>(pixel), chip.terms.device_id,
                                   RandomPurpose::kFixedPattern, plane),
                    kPatternKey));
                site.responsivity_e *=
                    static_cast<float>(at(chip.terms.transmittance, chip.terms, row, col));
                site.offset_e += columns[index(col)];
                site.gain = static_cast<float>(at(chip.terms.gain_map, chip.terms, row, col));
                sites_[plane * pixels_ + pixel] = site;
            }
        });
    }
}

}  // namespace stipple
