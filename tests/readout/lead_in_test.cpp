#include "readout/emulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/flux_video.h"
#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 9, .cols = 11, .planes = 1};

FluxVideo noise(int slots) {
    FluxVideo video(slots, kShape);
    std::mt19937 random(7);
    for (float& light : video.data()) light = static_cast<float>(random() % 4096) / 1024;
    return video;
}

SensorSetup setup_of(ExposureSchedule schedule, const PhysicalTerms& terms, int stores = 1) {
    SensorSetup setup = set_up_sensor({.sensor = "paper", .schedule = "full1x"}, kShape);
    setup.params.charge_stores = stores;
    setup.params.mode = SensorMode::kPhysical;
    setup.params.physical = terms;
    setup.schedule.schedule = std::move(schedule);
    return setup;
}

/// DN of the slots from `first` on, of an emulator that begins `lead_in` slots earlier.
std::vector<std::vector<std::uint16_t>> samples(const SensorSetup& setup, const FluxVideo& video,
                                                std::int64_t first, std::int64_t lead_in) {
    const std::int64_t begin = std::max<std::int64_t>(first - lead_in, 0);
    Emulator emulator(setup, begin);
    std::vector<std::vector<std::uint16_t>> dn;
    for (std::int64_t slot = begin; slot < video.slots(); ++slot)
        for (const SamplePacket& packet : emulator.expose(video.frame(static_cast<int>(slot)))) {
            EXPECT_EQ(packet.slot, slot);
            if (slot >= first) dn.push_back(packet.dn);
        }
    return dn;
}

struct Case {
    std::string name;
    SensorSetup setup;
};

std::vector<Case> cases() {
    const PhysicalTerms drifting{.dark_current_e_per_s = 1e4,
                                 .temperature_drift_c_per_s = 20,
                                 .row_noise_e = {3},
                                 .crosstalk = 0.1};
    PhysicalTerms skewed = drifting;
    skewed.row_skew_slots = 0.5;
    PhysicalTerms leaking = drifting;
    leaking.parasitic_light_sensitivity = 0.25;
    leaking.row_skew_slots = 1;
    return {
        {"random", setup_of(random_schedule(9, 11, kPaperExposureSlots, 1), {})},
        {"drift", setup_of(random_schedule(9, 11, kPaperExposureSlots, 1), drifting)},
        {"skew", setup_of(random_schedule(9, 11, kPaperExposureSlots, 1), skewed)},
        {"gaps", setup_of(gapped_schedule(5, 7, 29, 3), drifting)},
        {"gaps, closed stores", setup_of(gapped_schedule(5, 7, 29, 3), leaking)},
        {"two stores", setup_of(interleaved_schedule(4, 5, 7, 2), drifting, 2)},
        {"two stores, closed ones", setup_of(interleaved_schedule(4, 5, 7, 2), leaking, 2)},
        {"alternating stores", setup_of(alternating_schedule(), leaking, 2)},
        {"weights", setup_of(weighted_schedule(gapped_schedule(5, 7, 29, 3), 5), leaking)},
    };
}

TEST(LeadInTest, AfterItTheSamplesAreThoseOfOneRun) {
    const FluxVideo video = noise(180);
    for (const Case& one : cases()) {
        const auto whole = samples(one.setup, video, 0, 0);
        const std::int64_t lead_in = lead_in_slots(one.setup);
        for (const std::int64_t first : {1, 10, 31, 64, 100, 131, 179}) {
            SCOPED_TRACE(one.name + " from slot " + std::to_string(first));
            EXPECT_EQ(samples(one.setup, video, first, lead_in),
                      std::vector(whole.begin() + first, whole.end()));
        }
    }
}

TEST(LeadInTest, IsNoLongerThanTheLongestExposureNeeds) {
    FluxVideo video = noise(100);
    for (float& light : video.data()) light /= 16;  // so that 8 slots do not saturate
    const SensorSetup setup = setup_of(random_schedule(9, 11, kPaperExposureSlots, 1), {});
    EXPECT_EQ(lead_in_slots(setup), 7);  // of 8 slots, that which is read is in the part
    const auto whole = samples(setup, video, 0, 0);
    int different = 0;
    for (int first = 30; first < 45; ++first)
        if (samples(setup, video, first, 6) != std::vector(whole.begin() + first, whole.end()))
            ++different;
    EXPECT_GT(different, 0);
}

TEST(LeadInTest, OfClosedStoresIsAPeriodForEachStore) {
    const PhysicalTerms leaking{.parasitic_light_sensitivity = 0.25};
    EXPECT_EQ(lead_in_slots(setup_of(alternating_schedule(), leaking, 2)), 6 * 2 + 4);
    EXPECT_EQ(lead_in_slots(setup_of(alternating_schedule(), {}, 2)), 3);
}

TEST(LeadInTest, LightThatIsPassedOnWithoutEndIsRefused) {
    for (const auto& [terms, key] :
         {std::pair(PhysicalTerms{.lag = 0.1}, "has lag = 0.1"),
          std::pair(PhysicalTerms{.blooming = 0.5}, "has blooming = 0.5")}) {
        SensorSetup setup = setup_of(gapped_schedule(5, 7, 29, 3), terms);
        try {
            (void)lead_in_slots(setup);
            FAIL() << key;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr(key));
        }
        setup.params.mode = SensorMode::kPaper;  // has no such terms
        EXPECT_GT(lead_in_slots(setup), 0);
    }
}

}  // namespace
}  // namespace stipple
