// The statistics of what the sensor reads against the closed forms of Eq. 1.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "core/flux_video.h"
#include "readout/coded_sensor.h"
#include "readout/schedules/tiled_schedule.h"

namespace stipple {
namespace {

constexpr std::uint64_t kSeed = 11;
constexpr FrameShape kShape{.rows = 64, .cols = 64, .planes = 3};
constexpr double kFarOff = 5;  ///< standard deviations: by chance one time in 2 million

double electrons_to_dn(const SensorParams& params) {
    return ((1 << params.bit_depth) - 1) / params.full_scale_e;
}

/// Flux that differs from site to site and slot to slot, 0.15 to 0.2.
FluxVideo dim_footage(int slots) {
    FluxVideo video(slots, kShape);
    std::mt19937 random(1);
    for (float& flux : video.data()) flux = 0.15F + static_cast<float>(random() % 1000) / 20000;
    return video;
}

/// Sums over samples of DN - expected, of the variance expected of it, and of its square.
struct Deviation {
    double sum = 0;
    double variance = 0;
    double normalised_squares = 0;  ///< each over its variance
    double count = 0;

    void add(double deviation, double expected_variance) {
        sum += deviation;
        variance += expected_variance;
        normalised_squares += deviation * deviation / expected_variance;
        ++count;
    }
    /// Of the sum, in its standard deviations.
    [[nodiscard]] double z() const { return sum / std::sqrt(variance); }
};

/// Deviations of a random schedule's samples by slot and by length of the exposure.
struct Deviations {
    std::vector<Deviation> of_slot;
    std::map<int, Deviation> of_span;
};

/// Without clipping, a sum x of flux gives: mean g r x, less 1/2 where the converter cuts off;
/// variance g^2 (r x + sigma^2) + 1/12, with g = (2^d - 1) / s. Rounding adds the variance 1/12 and
/// no bias as long as the noise is no less than 0.7 DN (Widrow: the bias is below
/// exp(-2 pi^2 0.7^2) / pi = 2e-5 DN).
Deviations expose_dim_footage(const SensorParams& params) {
    const FluxVideo video = dim_footage(75);
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    CodedSensor sensor(params, kShape, schedule, kSeed);
    SamplePacket packet;
    Deviations found;
    const double g = electrons_to_dn(params);
    const double cut = params.rounding == Rounding::kFloor ? 0.5 : 0;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        Deviation in_slot;
        auto dn = packet.dn.begin();
        for (int row = 0; row < kShape.rows; ++row)
            for_each_readout(schedule, slot, row, kShape.cols, [&](int col, int span_slots) {
                for (int plane = 0; plane < kShape.planes; ++plane) {
                    double electrons = 0;
                    for (int open = slot - span_slots + 1; open <= slot; ++open)
                        electrons += params.photons_per_unit *
                                     static_cast<double>(video.plane(open, plane)(row, col));
                    const double deviation = *dn++ - (g * electrons - cut);
                    const double noise_e2 = electrons + params.read_noise_e * params.read_noise_e;
                    const double variance = g * g * noise_e2 + 1.0 / 12;
                    in_slot.add(deviation, variance);
                    found.of_span[span_slots].add(deviation, variance);
                }
            });
        EXPECT_EQ(dn, packet.dn.end());
        found.of_slot.push_back(in_slot);
    }
    return found;
}

/// 8 bits: 1.9 DN of noise or more. 6 bits: 0.7, where rounding is a seventh of the variance.
const std::vector<SensorParams>& dim_sensors() {
    static const std::vector<SensorParams> sensors = {
        {.name = "paper"},
        {.name = "coarse", .read_noise_e = 20, .bit_depth = 6},
        {.name = "floor", .read_noise_e = 20, .bit_depth = 6, .rounding = Rounding::kFloor}};
    return sensors;
}

TEST(CodedSensorNoiseTest, SumsOfEverySlotAreThoseOfTheLight) {
    for (const SensorParams& params : dim_sensors()) {
        double chi_square = 0;
        const auto slots = expose_dim_footage(params).of_slot;
        for (std::size_t slot = 0; slot < slots.size(); ++slot) {
            EXPECT_LT(std::abs(slots[slot].z()), kFarOff) << params.name << " slot " << slot;
            chi_square += slots[slot].z() * slots[slot].z();
        }
        // Too large if planes or neighbours shared their noise, too small if slots repeated it
        // with the other sign. Mean n and standard deviation sqrt(2 n) for n slots.
        const auto n = static_cast<double>(slots.size());
        EXPECT_NEAR(chi_square, n, kFarOff * std::sqrt(2 * n)) << params.name;
    }
}

TEST(CodedSensorNoiseTest, EveryExposureLengthHasTheVarianceOfEquationOne) {
    for (const SensorParams& params : dim_sensors()) {
        const auto found = expose_dim_footage(params).of_span;
        ASSERT_EQ(found.size(), 4U);
        for (const auto& [span_slots, deviation] : found) {
            EXPECT_LT(std::abs(deviation.z()), kFarOff) << params.name << ' ' << span_slots;
            // A square over its variance has mean 1 and variance 2 (a little more, as Poisson's
            // kurtosis is 3 + 1/mean, a mean of 150 or more).
            EXPECT_NEAR(deviation.normalised_squares / deviation.count, 1,
                        kFarOff * std::sqrt(2.01 / deviation.count))
                << params.name << ' ' << span_slots << " slots";
        }
    }
}

struct Moments {
    double mean = 0;
    double variance = 0;
    double fourth = 0;  ///< central
};

/// Of the DN of a normal charge: P(DN >= k) = P(charge >= edge of k), clipped at both ends.
Moments moments_of_normal(const SensorParams& params, double mean_e) {
    const int max_dn = (1 << params.bit_depth) - 1;
    const double below = params.rounding == Rounding::kNearest ? 0.5 : 0;
    const auto at_least = [&](int dn) {
        if (dn <= 0) return 1.0;
        if (dn > max_dn) return 0.0;
        const double edge_e = (dn - below) / electrons_to_dn(params);
        return 0.5 * std::erfc((edge_e - mean_e) / (params.read_noise_e * std::sqrt(2.0)));
    };
    const auto expect = [&](auto&& value) {
        double sum = 0;
        for (int dn = 0; dn <= max_dn; ++dn) sum += value(dn) * (at_least(dn) - at_least(dn + 1));
        return sum;
    };
    Moments m;
    m.mean = expect([](double dn) { return dn; });
    m.variance = expect([&](double dn) { return std::pow(dn - m.mean, 2); });
    m.fourth = expect([&](double dn) { return std::pow(dn - m.mean, 4); });
    return m;
}

/// DN of 16 slots of light `mean_e` all over the array, each slot an exposure.
std::vector<std::uint16_t> expose_flat(const SensorParams& params, double mean_e) {
    const auto schedule = full_schedule(1, 1);
    CodedSensor sensor(params, kShape, schedule, kSeed);
    const std::vector<float> frame(kShape.sites(),
                                   static_cast<float>(mean_e / params.photons_per_unit));
    std::vector<std::uint16_t> dn;
    SamplePacket packet;
    for (int slot = 0; slot < 16; ++slot) {
        sensor.expose(frame, packet);
        dn.insert(dn.end(), packet.dn.begin(), packet.dn.end());
    }
    return dn;
}

void expect_moments(const std::vector<std::uint16_t>& samples, const Moments& expected,
                    const std::string& which) {
    const auto n = static_cast<double>(samples.size());
    double sum = 0;
    double squares = 0;
    for (const std::uint16_t dn : samples) {
        sum += dn - expected.mean;
        squares += std::pow(dn - expected.mean, 2);
    }
    // The standard deviation of a mean, and of a mean square about the true mean. 1e-9: a constant.
    const double mean_spread = std::sqrt(expected.variance / n);
    const double square_spread =
        std::sqrt((expected.fourth - expected.variance * expected.variance) / n);
    EXPECT_NEAR(sum / n, 0, kFarOff * mean_spread + 1e-9) << which;
    EXPECT_NEAR(squares / n, expected.variance, kFarOff * square_spread + 1e-9) << which;
}

TEST(CodedSensorNoiseTest, IsANormalClippedAtZeroAndFullScale) {
    for (const Rounding rounding : {Rounding::kNearest, Rounding::kFloor})
        for (const double mean_e : {0.0, 7.0, 1000.0, 1995.0, 2000.0, 2020.0}) {
            const SensorParams params{.shot_noise = false, .rounding = rounding};
            expect_moments(expose_flat(params, mean_e), moments_of_normal(params, mean_e),
                           std::to_string(mean_e));
        }
}

// Rectified normal: mean sigma / sqrt(2 pi), variance sigma^2 (1/2 - 1/(2 pi)), from all 16 bits
// (1 DN is 0.003 sigma).
TEST(CodedSensorNoiseTest, DarkFramesAreARectifiedNormal) {
    const SensorParams params{.bit_depth = 16};
    const Moments dark = moments_of_normal(params, 0);
    const double sigma_dn = params.read_noise_e * electrons_to_dn(params);
    EXPECT_NEAR(dark.mean / sigma_dn, 0.398942, 1e-5);
    EXPECT_NEAR(std::sqrt(dark.variance) / sigma_dn, 0.583819, 1e-5);
    expect_moments(expose_flat(params, 0), dark, "dark");
}

// Light far beyond the full well: the well's charge without shot noise; read noise lies above it
// as well as below.
TEST(CodedSensorNoiseTest, AFullWellHasReadNoiseAlone) {
    for (const SensorMode mode : {SensorMode::kPaper, SensorMode::kPhysical}) {
        const SensorParams params{.full_well_e = 500, .bit_depth = 12, .mode = mode};
        const Moments well = moments_of_normal(params, 500);
        // 16 and 50 standard deviations from zero and full scale: an unclipped normal.
        const double g = electrons_to_dn(params);
        EXPECT_NEAR(well.mean, 500 * g, 1e-6);
        EXPECT_NEAR(well.variance, 100 * g * g + 1.0 / 12, 1e-6);
        expect_moments(expose_flat(params, 1500), well, "full well");
    }
}

}  // namespace
}  // namespace stipple
