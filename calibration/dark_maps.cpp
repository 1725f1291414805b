#include "calibration/dark_maps.h"

#include <limits>
#include <vector>

#include "core/index.h"

namespace stipple {

DarkMaps::DarkMaps(const StreamHeader& header, std::span<const FieldExposure> dark, int plane)
    : header_(header), dark_(dark), plane_(plane), first_(index(plane) * header.shape.pixels()) {}

EstimateMap DarkMaps::unmeasured() const {
    const std::size_t pixels = header_.shape.pixels();
    return {.rows = header_.shape.rows,
            .cols = header_.shape.cols,
            .value = std::vector<double>(pixels),
            .variance = std::vector<double>(pixels, std::numeric_limits<double>::infinity())};
}

template <typename Visit>
void DarkMaps::visit_means(std::size_t pixel, const Visit& visit) const {
    const std::size_t site = first_ + pixel;
    const std::size_t group = light_group(header_, site);
    for (const FieldExposure& exposure : dark_)
        if (exposure.has(site))
            visit(exposure.seconds, exposure.mean(site), 1 / exposure.mean_variance(site, group));
}

template <typename Visit>
void DarkMaps::visit_exposures(const Visit& visit) const {
    const std::size_t group = light_group(header_, first_);
    for (const FieldExposure& exposure : dark_) visit(exposure, 1 / exposure.usual_variance(group));
}

double DarkMaps::row_error(const FieldExposure& exposure) const {
    return exposure.row_error_dn2[index(plane_)];
}

EstimateMap DarkMaps::dark_currents() const {
    EstimateMap map = unmeasured();
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        double s = 0, st = 0, stt = 0, sy = 0, sty = 0;
        visit_means(i, [&](double t, double y, double weight) {
            s += weight;
            st += weight * t;
            stt += weight * t * t;
            sy += weight * y;
            sty += weight * t * y;
        });
        const double determinant = s * stt - st * st;
        map.value[i] = (s * sty - st * sy) / determinant;
        map.variance[i] = s / determinant;
    }
    double s = 0, st = 0, stt = 0;
    visit_exposures([&](const FieldExposure& exposure, double weight) {
        s += weight;
        st += weight * exposure.seconds;
        stt += weight * exposure.seconds * exposure.seconds;
    });
    visit_exposures([&](const FieldExposure& exposure, double weight) {
        const double factor = weight * (s * exposure.seconds - st) / (s * stt - st * st);
        map.row_error += factor * factor * row_error(exposure);
    });
    return map;
}

EstimateMap DarkMaps::offsets(const EstimateMap& dark_currents) const {
    EstimateMap map = unmeasured();
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        double s = 0, st = 0, sum = 0;
        visit_means(i, [&](double t, double y, double weight) {
            s += weight;
            st += weight * t;
            sum += weight * (y - dark_currents.value[i] * t);
        });
        const double mean_time = st / s;
        map.value[i] = sum / s;
        map.variance[i] = 1 / s + mean_time * mean_time * dark_currents.variance[i];
    }
    double s = 0, st = 0, error = 0;
    visit_exposures([&](const FieldExposure& exposure, double weight) {
        s += weight;
        st += weight * exposure.seconds;
        error += weight * weight * row_error(exposure);
    });
    map.row_error = (error + st * st * dark_currents.row_error) / (s * s);
    return map;
}

EstimateMap DarkMaps::readout_noise() const {
    EstimateMap map = unmeasured();
    for (std::size_t i = 0; i < map.value.size(); ++i)
        for (const FieldExposure& exposure : dark_) {
            const double n = exposure.sums->count[first_ + i];
            if (n < 2) continue;
            const double noise_dn2 = exposure.noise_dn2[light_group(header_, first_ + i)];
            map.value[i] = exposure.variance(first_ + i);
            map.variance[i] = 2 * noise_dn2 * noise_dn2 / (n - 1);
            break;
        }
    for (const FieldExposure& exposure : dark_) {
        const double n = static_cast<double>(exposure.sums->samples) /
                         static_cast<double>(exposure.sums->count.size());
        if (n < 2) continue;
        // Normal noise of covariance c gives sample variances the covariance 2 c^2 / (n - 1).
        const double shared_dn2 = row_error(exposure) * n;
        map.row_error = 2 * shared_dn2 * shared_dn2 / (n - 1);
        break;
    }
    return map;
}

}  // namespace stipple
