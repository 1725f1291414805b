#include "sensor_model/sensor_params.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "sensor_model/portable_math.h"
#include "sensor_model/sensor_keys.h"

namespace stipple {
namespace {

[[noreturn]] void fail(const SensorParams& params, std::string_view key, std::string_view problem) {
    throw InputError(fmt::format("sensor \"{}\": {}", params.name, key), problem);
}

/// \throws InputError for a number outside the range of its key.
class RangeCheck {
  public:
    explicit RangeCheck(const SensorParams& params) : params_(params) {}

    template <typename Value>
    void operator()(const ConfigKey& key, const Value& value) const {
        if constexpr (std::is_same_v<Value, std::vector<double>>)
            for (const double item : value) check(key, item);
        else if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
            check(key, static_cast<double>(value));
    }

  private:
    void check(const ConfigKey& key, double value) const {
        const auto [min, max] = key.range;
        if (value >= min && value <= max) return;  // false for NaN
        fail(params_, key.name, fmt::format("{} is outside {} .. {}", value, min, max));
    }

    const SensorParams& params_;
};

void check_map(const SensorParams& params, std::string_view key, const std::vector<double>& map) {
    const PhysicalTerms& terms = params.physical;
    const auto pixels =
        static_cast<std::size_t>(terms.map_rows) * static_cast<std::size_t>(terms.map_cols);
    if (!map.empty() && map.size() != pixels)
        fail(params, key,
             fmt::format("has {} values, but its tile has map_rows x map_cols = {} x {} pixels",
                         map.size(), terms.map_rows, terms.map_cols));
}

/// What must hold between the terms of the physical mode.
void check_together(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    const int max_dn = (1 << params.bit_depth) - 1;
    if (terms.black_level_dn >= max_dn)
        fail(params, "black_level_dn",
             fmt::format("{} leaves nothing of the converter's {} DN for light; take more bits or "
                         "a larger full_scale_e",
                         terms.black_level_dn, max_dn));
    if (4 * std::abs(terms.inl_dn) >= max_dn)
        fail(
            params, "inl_dn",
            fmt::format("{} makes the converter's curve fall; it has {} DN, so less than a quarter "
                        "of them",
                        terms.inl_dn, max_dn));
    if (!(params.dark_e_per_slot() <= 1e9))
        fail(params, "dark_current_e_per_s",
             fmt::format("{:.3g} electrons in a slot at {} degrees; more than 1e9",
                         params.dark_e_per_slot(), terms.temperature_c));
    if ((terms.storage_wait_us == 0) != (terms.storage_dark_current_e_per_s == 0))
        fail(params, "storage_wait_us",
             "needs storage_dark_current_e_per_s, and the other way round");
    if (params.storage_dark_e() / 2 >= (max_dn - terms.black_level_dn) * params.gain_e_per_dn())
        fail(params, "storage_dark_current_e_per_s", "leaves nothing of the converter for light");
    if ((terms.dual_gain_limit_e == 0) != (terms.low_gain_read_noise_e == 0))
        fail(params, "dual_gain_limit_e", "needs low_gain_read_noise_e, and the other way round");
    if (terms.hot_pixel_fraction + terms.dead_pixel_fraction > 0.5)
        fail(params, "hot_pixel_fraction", "more than half of the pixels are hot or dead");
}

/// Mean electrons that a dark current gives in a time.
double dark_e(const SensorParams& params, double current_e_per_s, double time_us) {
    const double warmer_c = params.physical.temperature_c - params.physical.dark_reference_c;
    return current_e_per_s * power_of_two(warmer_c / params.physical.dark_doubling_c) *
           (time_us * 1e-6);
}

void check_physical(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    visit_physical_keys(terms, RangeCheck(params));
    if (terms.row_noise_e.size() > std::size_t{kMaxTaps})
        fail(params, "row_noise_e", fmt::format("has more than {} values", kMaxTaps));
    check_map(params, "transmittance", terms.transmittance);
    check_map(params, "gain_map", terms.gain_map);
    check_together(params);
}

}  // namespace

double SensorParams::dark_e_per_slot() const {
    return dark_e(*this, physical.dark_current_e_per_s, slot_us);
}

double SensorParams::storage_dark_e() const {
    return dark_e(*this, physical.storage_dark_current_e_per_s, physical.storage_wait_us);
}

double SensorParams::saturation_e() const {
    const int max_dn = (1 << bit_depth) - 1;
    const double range_e = (max_dn - physical.black_level_dn) * gain_e_per_dn();
    return std::min(full_well_e, range_e) - dark_e_per_slot() - storage_dark_e() / 2;
}

double SensorParams::temporal_read_noise_e() const {
    if (mode == SensorMode::kPaper) return read_noise_e;
    double row2 = 0;
    for (const double noise : physical.row_noise_e) row2 += noise * noise;
    if (!physical.row_noise_e.empty()) row2 /= static_cast<double>(physical.row_noise_e.size());
    const double column = physical.column_temporal_noise_e;
    return std::sqrt(read_noise_e * read_noise_e + physical.reset_noise_e * physical.reset_noise_e +
                     row2 + column * column + storage_dark_e() / 2);
}

double default_black_level_dn(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    const double temporal_e = params.temporal_read_noise_e();
    const double all_e = std::sqrt(temporal_e * temporal_e + terms.dsnu_e * terms.dsnu_e +
                                   terms.column_noise_e * terms.column_noise_e);
    double largest_gain = 1;
    for (const double gain : terms.gain_map) largest_gain = std::max(largest_gain, gain);
    return std::ceil(4 * all_e * largest_gain / params.gain_e_per_dn());
}

void validate(const SensorParams& params) {
    visit_sensor_keys(params, RangeCheck(params));
    if (params.mode == SensorMode::kPhysical) return check_physical(params);
    if (params.physical != PhysicalTerms{})
        fail(params, "mode", "\"paper\" has the terms of Eq. 1 only; take \"physical\"");
}

}  // namespace stipple
