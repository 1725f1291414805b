#include "readout/flat_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

double mean_of(const std::vector<std::uint16_t>& dn) {
    return std::accumulate(dn.begin(), dn.end(), 0.0) / static_cast<double>(dn.size());
}

TEST(FlatFieldTest, ExposuresAreThoseOfEmva1288) {
    SensorParams params{.mode = SensorMode::kPhysical};
    params.physical.quantum_efficiency = 0.5;
    const auto exposures = flat_field_exposures(params);
    ASSERT_EQ(exposures.size(), 53U);
    EXPECT_EQ(exposures.front().photons, 0);
    EXPECT_EQ(exposures.front().images, 2);
    // The converter is full at 2000 electrons, which take 4000 photons.
    EXPECT_NEAR(exposures[1].photons, 4000 * 1.15 / 50, 1e-9);
    EXPECT_NEAR(exposures[50].photons, 4000 * 1.15, 1e-9);
    EXPECT_NEAR(exposures[51].photons, 2000, 1e-9);
    EXPECT_EQ(exposures[51].images, 100);
    EXPECT_EQ(exposures[52].photons, 0);
    EXPECT_EQ(exposures[52].images, 100);
}

// Mean electrons p of 76800 pixels have the deviation sqrt(p + 10^2) / sqrt(76800); within 5 of it.
TEST(FlatFieldTest, MeanOfAnImageIsItsLight) {
    SensorParams params;
    params.bit_depth = 12;
    FlatField field(params, 1);
    for (const double photons : {100.0, 400.0, 1500.0}) {
        const auto& dn = field.capture(photons);
        ASSERT_EQ(dn.size(), FlatField::kShape.pixels());
        const double electrons = mean_of(dn) * params.gain_e_per_dn();
        EXPECT_NEAR(electrons, photons, 5 * std::sqrt((photons + 100) / 76800)) << photons;
    }
}

TEST(FlatFieldTest, SeedDecidesTheImages) {
    FlatField a(SensorParams{}, 1), b(SensorParams{}, 1), c(SensorParams{}, 2);
    const auto first = a.capture(500);
    EXPECT_EQ(b.capture(500), first);
    EXPECT_NE(c.capture(500), first);
    EXPECT_NE(a.capture(500), first);  // another slot
}

TEST(FlatFieldTest, UnequalPixelsAreRefused) {
    const SensorParams equal{.mode = SensorMode::kPhysical};
    SensorParams filtered = equal, amplified = equal;
    filtered.physical.transmittance = {1, 0.5};
    amplified.physical.gain_map = {1, 0.5};
    for (const SensorParams& params : {filtered, amplified})
        expect_parts(
            message_of<InputError>([&] { return FlatField(params, 1); }),
            {"pixels of unequal transmittance or gain", "transmittance=[] and gain_map=[]"});
}

}  // namespace
}  // namespace stipple
