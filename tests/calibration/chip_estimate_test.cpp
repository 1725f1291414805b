#include "calibration/chip_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/error.h"
#include "readout/flat_field.h"
#include "sensor_model/fixed_pattern.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 64, .cols = 64, .planes = 1};
constexpr double kPixels = 64 * 64;
/// Five standard deviations of a mean of 4096 squares of normal deviates.
const double kScatter = 5 * std::sqrt(2 / kPixels);

/// A chip of 16 bits whose sites differ: y = 500 + offset + dark t + gain light t, in DN.
struct Chip {
    std::vector<double> gain, offset, dark;
    double row_noise_dn = 0;      ///< of each row of each frame
    int rows_read = kShape.rows;  ///< of each frame

    explicit Chip(double prnu, double dsnu, double dark_spread) {
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < kShape.sites(); ++i) {
            gain.push_back(1 + prnu * normal(random));
            offset.push_back(dsnu * normal(random));
            dark.push_back(100 + dark_spread * normal(random));
        }
        double mean = 0;
        for (const double g : gain) mean += g / kPixels;
        for (double& g : gain) g /= mean;
    }
};

StreamHeader header_of(double slot_us) {
    return {.shape = kShape,
            .slot_us = slot_us,
            .calibration = {.bit_depth = 16,
                            .black_level_dn = 500,
                            .gain_e_per_dn = 1,
                            .full_well_e = 1e6},
            .schedule = {1, 1, 1, {0, 1}, {{0, 1}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = ""};
}

/// Adds frames of normal noise with this standard deviation.
void expose(const Chip& chip, double slot_us, double light_dn_per_s, int frames, double noise_dn,
            FieldSamples& field) {
    std::mt19937 random(static_cast<std::uint32_t>(slot_us) + (light_dn_per_s > 0 ? 1 : 0));
    std::normal_distribution<double> normal;
    const StreamHeader header = header_of(slot_us);
    FieldCollector collector(header, field);
    const double t = slot_us * 1e-6;
    for (int frame = 0; frame < frames; ++frame) {
        SamplePacket packet{.slot = frame, .rows = chip.rows_read, .dn = {}};
        double row_dn = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(chip.rows_read) * 64; ++i) {
            if (i % 64 == 0 && chip.row_noise_dn > 0) row_dn = chip.row_noise_dn * normal(random);
            packet.dn.push_back(static_cast<std::uint16_t>(std::clamp(
                std::round(500 + chip.offset[i] + chip.dark[i] * t +
                           chip.gain[i] * light_dn_per_s * t + row_dn + noise_dn * normal(random)),
                0.0, 65535.0)));
        }
        collector.add(packet);
    }
}

struct Series {
    FieldSamples dark{kShape};
    FieldSamples flat{kShape};
    StreamHeader header = header_of(5000);

    [[nodiscard]] ChipEstimate estimate() const {
        return estimate_chip({.header = header, .dark = dark, .flats = {&flat, 1}});
    }
    [[nodiscard]] std::string message() const {
        return message_of<InputError>([&] { return estimate(); });
    }
};

/// Two dark exposure times and flats of about 10^4 DN.
Series series_of(const Chip& chip, int frames, double noise_dn) {
    Series series;
    expose(chip, 5000, 0, frames, noise_dn, series.dark);
    expose(chip, 80000, 0, frames, noise_dn, series.dark);
    expose(chip, 5000, 2e6, frames, noise_dn, series.flat);
    return series;
}

/// Error of an estimate in the standard deviations that it reports: mean, and mean square.
struct Normalised {
    double mean = 0;
    double square = 0;

    void add(double estimate, double truth, float variance) {
        const double z = (estimate - truth) / std::sqrt(static_cast<double>(variance));
        mean += z / kPixels;
        square += z * z / kPixels;
    }
    void expect_standard() const {
        // The mean of all sites has an error of its own, that of the pattern's mean.
        EXPECT_NEAR(mean, 0, 5 / std::sqrt(kPixels));
        EXPECT_NEAR(square, 1, kScatter);
    }
};

TEST(ChipEstimateTest, ErrorsHaveNoBiasAndTheVariancesReported) {
    const Chip chip(0.02, 3, 40);
    const ChipEstimate estimate = series_of(chip, 25, 10).estimate();
    Normalised gain, offset, dark;
    for (std::size_t i = 0; i < kShape.sites(); ++i) {
        const SiteCalibration& site = estimate.calibration.sites[i];
        gain.add(static_cast<double>(site.gain), chip.gain[i], site.gain_variance);
        offset.add(static_cast<double>(site.offset_dn), 500 + chip.offset[i],
                   site.offset_variance_dn2);
        dark.add(static_cast<double>(site.dark_dn_per_s), chip.dark[i], site.dark_variance);
    }
    gain.expect_standard();
    offset.expect_standard();
    dark.expect_standard();
    EXPECT_EQ(estimate.calibration.flats, 25U);
    EXPECT_EQ(estimate.calibration.darks, 50U);
}

// A flat of 10^4 DN with a noise of 10 DN measures a gain to 10 / 10^4 / sqrt(25); the offset adds
// its own error. Against a PRNU of 2 % nothing is shrunk.
TEST(ChipEstimateTest, GainVarianceIsThatOfFlatFieldCorrection) {
    const Chip chip(0.02, 0, 0);
    const ChipEstimate estimate = series_of(chip, 25, 10).estimate();
    EXPECT_NEAR(std::sqrt(static_cast<double>(estimate.calibration.sites[0].gain_variance)),
                10.0 / 1e4 / 5, 0.05 * 10.0 / 1e4 / 5);
    EXPECT_NEAR(std::sqrt(estimate.gain.pixels), 0.02, 0.02 * kScatter);
}

// The mean of n frames has the row noise of variance s^2 / n in all pixels of a row. 64 rows of 25
// frames tell s^2 to sqrt(2 / (64 x 24)) = 3.6 %.
TEST(ChipEstimateTest, RowNoiseIsNoPatternOfRows) {
    Chip chip(0.02, 3, 40);
    chip.row_noise_dn = 5;
    const Series series = series_of(chip, 25, 10);
    for (const auto& [time, sums] : series.dark.exposures())
        EXPECT_NEAR(sums.row_error(0, kShape), 25.0 / 25, 5 * 0.036);
    const ChipEstimate estimate = series.estimate();
    EXPECT_EQ(estimate.offset_dn.rows, 0);
    EXPECT_EQ(estimate.dark_dn_per_s.rows, 0);
    EXPECT_EQ(estimate.gain.rows, 0);
    EXPECT_EQ(estimate.readout_noise_dn2.rows, 0);
    EXPECT_NEAR(estimate.offset_dn.pixels, 9, 9 * 2 * kScatter);
}

TEST(ChipEstimateTest, APatternOfRowsIsFoundBesideRowNoise) {
    Chip chip(0, 0, 0);
    chip.row_noise_dn = 5;
    for (std::size_t i = 0; i < kShape.sites(); ++i) chip.offset[i] = i / 64 % 2 == 0 ? 3 : -3;
    const ChipEstimate estimate = series_of(chip, 25, 10).estimate();
    // Offsets of +-3 DN, each with an error of about 1 DN: the variance of 64 rows has one of
    // 2 x 3 x 1 / sqrt(64) and sqrt(2 / 64) x 1.
    EXPECT_NEAR(estimate.offset_dn.rows, 9, 5 * std::hypot(0.75, 0.18));
}

TEST(ChipEstimateTest, WithoutNoiseThePatternIsExact) {
    const Chip chip(0.05, 3, 40);
    const ChipEstimate estimate = series_of(chip, 8, 0).estimate();
    for (std::size_t i = 0; i < kShape.sites(); ++i) {
        const SiteCalibration& site = estimate.calibration.sites[i];
        // Rounding to 0.5 DN, of 10^4 DN and over 75 ms; shrinking takes less than another half.
        EXPECT_NEAR(static_cast<double>(site.gain), chip.gain[i], 1e-4);
        EXPECT_NEAR(static_cast<double>(site.offset_dn), 500 + chip.offset[i], 1);
        EXPECT_NEAR(static_cast<double>(site.dark_dn_per_s), chip.dark[i], 1 / 0.075);
    }
}

TEST(ChipEstimateTest, DeadAndSaturatedPixelsAreDefects) {
    Chip chip(0.02, 3, 40);
    chip.gain[100] = 0;
    chip.dark[200] = 1e7;  // 65535 DN after 7 ms
    const ChipEstimate estimate = series_of(chip, 10, 10).estimate();
    EXPECT_TRUE(estimate.calibration.sites[100].defect);
    EXPECT_TRUE(estimate.calibration.sites[200].defect);
    EXPECT_EQ(estimate.defects, 2U);
    EXPECT_NEAR(std::sqrt(estimate.gain.pixels), 0.02, 0.02 * kScatter);
}

TEST(ChipEstimateTest, NamesTooFewFrames) {
    expect_parts(series_of(Chip(0.02, 3, 0), 3, 10).message(),
                 {"dark series: has too few frames: 6 samples of a pixel"});
    Series series = series_of(Chip(0.02, 3, 0), 10, 10);
    series.flat = FieldSamples(kShape);
    expect_parts(series.message(), {"flat series: has too few frames: 0 samples of a pixel"});
}

TEST(ChipEstimateTest, NamesADarkSeriesOfOneExposureTime) {
    const Chip chip(0.02, 3, 0);
    Series series;
    expose(chip, 5000, 0, 10, 10, series.dark);
    expose(chip, 5000, 2e6, 10, 10, series.flat);
    expect_parts(series.message(), {"dark series: ", "one exposure time only (5 ms)"});
    const ChipEstimate estimate = estimate_chip({.header = series.header,
                                                 .dark = series.dark,
                                                 .flats = {&series.flat, 1},
                                                 .dark_current = false});
    EXPECT_EQ(estimate.calibration.sites[0].dark_dn_per_s, 0);
    EXPECT_EQ(estimate.calibration.sites[0].dark_variance, 0);
}

TEST(ChipEstimateTest, NamesAFlatSeriesThatSaturatesOrIsDark) {
    const Chip chip(0.02, 3, 0);
    Series series = series_of(chip, 10, 10);
    series.flat = FieldSamples(kShape);
    expose(chip, 5000, 13e6, 10, 10, series.flat);  // 65000 +- 1300 DN
    expect_parts(series.message(), {"flat series: saturates: ", "half of saturation"});
    series.flat = FieldSamples(kShape);
    expose(chip, 5000, 100, 10, 10, series.flat);  // half a DN
    expect_parts(series.message(), {"flat series: is not brighter than its noise"});
}

// Above an unknown full well light adds no noise.
TEST(ChipEstimateTest, NamesAFlatSeriesWithoutShotNoise) {
    const Series series = series_of(Chip(0.02, 3, 0), 10, 10);
    expect_parts(message_of<InputError>([&] {
                     return estimate_chip({.header = series.header,
                                           .dark = series.dark,
                                           .flats = {&series.flat, 1},
                                           .well_known = false});
                 }),
                 {"flat series: saturates: its noise is that of the dark series"});
}

TEST(ChipEstimateTest, PixelsWithoutTheShortDarkExposureHideNoMissingShotNoise) {
    Chip chip(0.02, 3, 0);
    Series series;
    expose(chip, 80000, 0, 10, 10, series.dark);
    expose(chip, 5000, 2e6, 10, 10, series.flat);
    chip.rows_read = 63;
    expose(chip, 5000, 0, 10, 10, series.dark);
    expect_parts(message_of<InputError>([&] {
                     return estimate_chip({.header = series.header,
                                           .dark = series.dark,
                                           .flats = {&series.flat, 1},
                                           .well_known = false,
                                           .dark_current = false});
                 }),
                 {"flat series: saturates: its noise is that of the dark series"});
}

TEST(ChipEstimateTest, NamesADarkSeriesThatIsCutOff) {
    Chip chip(0.02, 0, 0);
    for (double& offset : chip.offset) offset = -500;
    expect_parts(series_of(chip, 10, 10).message(), {"dark series: ", "samples are DN 0"});
}

// Their ratio of light is not known. Each tells the gains, and their weighted mean tells them best.
TEST(ChipEstimateTest, FlatsOfSeveralLightsAreCombined) {
    const Chip chip(0.02, 3, 40);
    const Series series = series_of(chip, 25, 10);
    FieldSamples dim(kShape);
    expose(chip, 6000, 1e6, 25, 10, dim);
    const std::vector<FieldSamples> flats{series.flat, dim};
    const ChipEstimate one = series.estimate();
    const ChipEstimate both =
        estimate_chip({.header = series.header, .dark = series.dark, .flats = flats});
    Normalised gain;
    for (std::size_t i = 0; i < kShape.sites(); ++i) {
        const SiteCalibration& site = both.calibration.sites[i];
        gain.add(static_cast<double>(site.gain), chip.gain[i], site.gain_variance);
    }
    // Both have the offset's error, which counts as independent: 3 DN of 10^4, 2 DN of a frame.
    EXPECT_NEAR(gain.square, 1, kScatter + 0.2);
    EXPECT_LT(both.calibration.sites[0].gain_variance, one.calibration.sites[0].gain_variance);
    EXPECT_EQ(both.calibration.flats, 50U);
    EXPECT_EQ(both.response.levels, 0U);
}

/// An emulated chip of 12 bits with this response loss.
SensorParams emulated_chip(double response_loss) {
    return {.photons_per_unit = 1000,
            .full_scale_e = 16000,
            .full_well_e = 16000,
            .read_noise_e = 10,
            .bit_depth = 12,
            .mode = SensorMode::kPhysical,
            .physical = {.dark_current_e_per_s = 100,
                         .dsnu_e = 20,
                         .prnu = 0.03,
                         .column_noise_e = 8,
                         .black_level_dn = 64,
                         .response_loss = response_loss,
                         .device_id = 5}};
}

/// Its estimate from the series of the emulator.
ChipEstimate estimate_of(const SensorParams& params, int levels) {
    FieldSamples dark(kShape), flat(kShape);
    for (const CalibrationExposure& exposure :
         calibration_exposures(params, {.darks = 50, .flats = 50, .levels = levels}, 1)) {
        SensorParams timed = params;
        timed.slot_us = exposure.slot_us;
        FlatField field(timed, exposure.seed, kShape);
        FieldCollector collector(field.header(), exposure.photons > 0 ? flat : dark);
        for (int i = 0; i < exposure.images; ++i) collector.add(field.expose(exposure.photons));
    }
    const StreamHeader header = FlatField(params, 1, kShape).header();
    return estimate_chip({.header = header, .dark = dark, .flats = {&flat, 1}});
}

// The truth is that of the emulator; its mean responsivity is that of the header. `excess` is what
// the mean square error of the gains may exceed the variances reported by.
void expect_pattern(const SensorParams& params, const ChipEstimate& estimate, double excess) {
    const FixedPattern truth(params, kShape);
    const SiteParams* traits = truth.plane(0);
    double mean = 0;
    for (std::size_t i = 0; i < kShape.sites(); ++i)
        mean += static_cast<double>(traits[i].responsivity_e) / kPixels;
    Normalised gain, offset;
    for (std::size_t i = 0; i < kShape.sites(); ++i) {
        const SiteCalibration& site = estimate.calibration.sites[i];
        gain.add(static_cast<double>(site.gain),
                 static_cast<double>(traits[i].responsivity_e) / mean, site.gain_variance);
        offset.add(static_cast<double>(site.offset_dn),
                   64 + static_cast<double>(traits[i].offset_e) / params.gain_e_per_dn(),
                   site.offset_variance_dn2);
    }
    EXPECT_NEAR(gain.square, 1, kScatter + excess);
    EXPECT_NEAR(offset.square, 1, kScatter + 0.1);
    EXPECT_NEAR(estimate.dark_dn_per_s.mean * params.gain_e_per_dn(), 100, 5);
    EXPECT_GT(estimate.offset_dn.cols, 0);
    EXPECT_EQ(estimate.offset_dn.rows, 0);
}

TEST(ChipEstimateTest, AnEmulatedChipGivesBackItsPattern) {
    const SensorParams params = emulated_chip(0);
    const ChipEstimate estimate = estimate_of(params, 0);
    // The noise of a flat grows with its gain, whose mean square the pooled noise has: up to 10 %.
    expect_pattern(params, estimate, 0.1);
    EXPECT_EQ(estimate.response.levels, 0U);
    EXPECT_TRUE(estimate_of(params, 8).calibration.response.linear_dn.empty());
}

TEST(ChipEstimateTest, ABentEmulatedChipGivesBackItsPatternAndItsCurve) {
    const double loss = 0.15;
    const SensorParams params = emulated_chip(loss);
    const ChipEstimate estimate = estimate_of(params, 12);
    // The errors of the curve and the noise by its slope differ among sites: up to 20 % (measured).
    expect_pattern(params, estimate, 0.2);
    const std::vector<float>& f = estimate.calibration.response.linear_dn;
    ASSERT_EQ(f.size(), 4096U);
    // A charge of q DN gives q (1 - 0.15 q / well), to 0.1 % of the well. The mean over a PRNU of
    // 3 % is that of a charge that is 0.0009 x 0.15 lower.
    const double well_dn = params.full_well_e / params.gain_e_per_dn();
    for (const double q : {100.0, 1000.0, 2000.0, 3000.0}) {
        const double dn = 64 + q * (1 - loss * q / well_dn);
        EXPECT_NEAR(static_cast<double>(f[static_cast<std::size_t>(std::lround(dn))]) - 64 - q,
                    std::round(dn) - dn, 4)
            << q;
    }
}

}  // namespace
}  // namespace stipple
