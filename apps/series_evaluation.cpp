#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/flat_field_series.h"
#include "core/error.h"
#include "core/input_file.h"
#include "io/dn_image.h"

namespace stipple {
namespace {

void check(const DnImage& image, const emva1288::Series& series, const std::string& place) {
    if (image.shape.rows != series.rows || image.shape.cols != series.cols)
        throw InputError(
            place, fmt::format("is {} x {}, but the descriptor says {} x {}", image.shape.cols,
                               image.shape.rows, series.cols, series.rows));
    const int most = *std::ranges::max_element(image.dn);
    if (most >> series.bits != 0)
        throw InputError(place, fmt::format("holds the DN {}, but the descriptor says {} bits",
                                            most, series.bits));
}

emva1288::GroupStatistics read_group(const emva1288::Series& series,
                                     const emva1288::ImageGroup& group,
                                     const std::filesystem::path& folder,
                                     const std::function<void()>& advance) {
    emva1288::ImageStack stack;
    std::int64_t zeros = 0, values = 0;
    for (const std::string& file : group.files) {
        const DnImage image = read_dn_image(folder / file);
        check(image, series, (folder / file).string());
        stack.add(image.dn);
        zeros += std::ranges::count(image.dn, 0);
        values += std::ssize(image.dn);
        advance();
    }
    return {.images = stack.statistics(),
            .zero_fraction = static_cast<double>(zeros) / static_cast<double>(values)};
}

}  // namespace

emva1288::Evaluation evaluate_series(const std::filesystem::path& descriptor,
                                     const std::string& place,
                                     const std::function<void()>& advance) {
    const auto bytes = read_file(descriptor);
    const emva1288::Series series =
        emva1288::parse_series({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, place);
    std::vector<emva1288::GroupStatistics> statistics;
    for (const emva1288::ImageGroup& group : series.groups)
        statistics.push_back(read_group(series, group, descriptor.parent_path(), advance));
    return emva1288::evaluate(series, statistics, place);
}

emva1288::CameraFigures configured_figures(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    const int max_dn = (1 << params.bit_depth) - 1;
    const double range_e = (max_dn - terms.black_level_dn) * params.gain_e_per_dn();
    const double alive = 1 - terms.dead_pixel_fraction;
    SensorParams hot = params;
    hot.physical.dark_current_e_per_s = terms.hot_pixel_dark_current;
    const double dark_e = params.dark_e_per_slot();
    const double hot_e = hot.dark_e_per_slot();
    const double share = terms.hot_pixel_fraction;
    const double read_e = params.temporal_read_noise_e();

    emva1288::CameraFigures f;
    f.gain_dn_per_e = 1 / params.gain_e_per_dn();
    f.quantum_efficiency = terms.quantum_efficiency * alive;
    f.dark_noise_e = std::sqrt(read_e * read_e + dark_e + share * hot_e);
    f.saturation_e = std::min(params.full_well_e, range_e) - dark_e;
    f.dsnu_e = std::sqrt(terms.dsnu_e * terms.dsnu_e + terms.column_noise_e * terms.column_noise_e +
                         share * (1 - share) * hot_e * hot_e);
    f.prnu = std::sqrt((1 + terms.prnu * terms.prnu) / alive - 1);
    f.snr_max = std::sqrt(f.saturation_e);
    const double noise2_e2 =
        f.dark_noise_e * f.dark_noise_e + params.gain_e_per_dn() * params.gain_e_per_dn() / 12;
    f.sensitivity_threshold_p = (std::sqrt(noise2_e2 + 0.25) + 0.5) / f.quantum_efficiency;
    f.dynamic_range = f.saturation_e / f.quantum_efficiency / f.sensitivity_threshold_p;
    return f;
}

}  // namespace stipple
