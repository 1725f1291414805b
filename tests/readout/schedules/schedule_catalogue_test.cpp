#include "readout/schedules/schedule_catalogue.h"
#include "readout/schedules/tiled_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "readout/schedules/cell_schedule.h"
#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/random_codes.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 12, .cols = 20, .planes = 3};
constexpr std::uint64_t kSeed = 5;

NamedSchedule read(const std::string& name, const std::vector<std::string>& overrides = {},
                   FrameShape shape = kShape) {
    const auto folder = project_path("config/schedules");
    Config config(folder / (name + ".toml"), overrides);
    NamedSchedule schedule = read_schedule(config, shape, kSeed);
    config.reject_unknown_keys();
    return schedule;
}

std::string problem_of(const std::string& name, const std::vector<std::string>& overrides,
                       FrameShape shape = kShape) {
    return message_of<InputError>([&] { return read(name, overrides, shape); });
}

TEST(ScheduleCatalogueTest, RandomIsStoredAsItsSeed) {
    const auto random = read("random");
    EXPECT_EQ(random.name, "random");
    EXPECT_EQ(random.source, (ScheduleSource{ScheduleSource::Kind::kRandom, {1, 2, 4, 8}, kSeed}));
    EXPECT_EQ(random.schedule, random_schedule(12, 20, kPaperExposureSlots, kSeed));
}

// docs/schedules.md: N slots hold (4 N - 11) / 15 samples a pixel. The first slots count, as what
// began before slot 0 is not read. In 32 slots a pixel has 7 to 9 samples, so its standard
// deviation is at most 1.
TEST(ScheduleCatalogueTest, AClipHoldsTheSamplesOfTheClosedForm) {
    constexpr FrameShape kLarge{.rows = 240, .cols = 320, .planes = 1};
    const auto pixels = static_cast<double>(kLarge.pixels());
    for (const char* name : {"random", "tiled"}) {
        const auto schedule = read(name, {}, kLarge).schedule;
        std::size_t samples = 0;
        for (int slot = 0; slot < 32; ++slot)
            samples += count_due(schedule, slot, 0, kLarge.rows, kLarge.cols);
        const double independent =
            std::min<double>(pixels, schedule.tile_rows() * schedule.tile_cols());
        EXPECT_NEAR(static_cast<double>(samples) / pixels, 117.0 / 15, 5 / std::sqrt(independent))
            << name;
    }
}

TEST(ScheduleCatalogueTest, TiledIsATileOf16By16) {
    const auto tiled = read("tiled");
    EXPECT_EQ(tiled.name, "tiled");
    EXPECT_EQ(tiled.source, ScheduleSource{});
    EXPECT_EQ(tiled.schedule, tiled_schedule(16, 16, kPaperExposureSlots, kSeed));
}

TEST(ScheduleCatalogueTest, ConventionalCamerasReadAllPixelsEveryFourthSlot) {
    const auto long_exposure = read("full4x");
    EXPECT_EQ(long_exposure.name, "full4x");
    EXPECT_EQ(long_exposure.source, ScheduleSource{});
    EXPECT_EQ(long_exposure.schedule, ExposureSchedule(1, 1, 4, {0, 1}, {{0, 0b1111}}));
    EXPECT_EQ(long_exposure.schedule.light_throughput(), 1.0);
    EXPECT_EQ(long_exposure.schedule.samples_per_pixel_slot(), 0.25);

    const auto short_exposure = read("full1x");
    EXPECT_EQ(short_exposure.name, "full1x");
    EXPECT_EQ(short_exposure.schedule, ExposureSchedule(1, 1, 4, {0, 1}, {{0, 0b1}}));
    EXPECT_EQ(short_exposure.schedule.light_throughput(), 0.25);
    EXPECT_EQ(short_exposure.schedule.samples_per_pixel_slot(), 0.25);
}

// The files show the defaults: taking a file's keys away changes nothing.
TEST(ScheduleCatalogueTest, AnEmptyFileMeansTheDefaultsOfItsKind) {
    const TemporaryFolder folder;
    write_text(folder / "empty.toml", "");
    for (const char* kind : {"random", "tiled", "full"}) {
        Config config(folder / "empty.toml", {std::string("kind=") + kind});
        const auto shown = read(std::string(kind) == "full" ? "full4x" : kind);
        EXPECT_EQ(read_schedule(config, kShape, kSeed).schedule, shown.schedule) << kind;
    }
}

TEST(ScheduleCatalogueTest, ReadsEveryKey) {
    const int lengths[] = {3, 5};
    EXPECT_EQ(read("tiled", {"tile_rows=4", "tile_cols=8", "exposure_slots=[3,5]"}).schedule,
              tiled_schedule(4, 8, lengths, kSeed));
    const auto random = read("random", {"exposure_slots=[3,5]", "name=mine"});
    EXPECT_EQ(random.schedule, random_schedule(12, 20, lengths, kSeed));
    EXPECT_EQ(random.source.exposure_slots, (std::vector<int>{3, 5}));
    EXPECT_EQ(random.name, "mine");
    EXPECT_EQ(read("full4x", {"open_slots=2", "period_slots=7"}).schedule, full_schedule(2, 7));
}

TEST(ScheduleCatalogueTest, HardwareTiledSuitsTheSensorUnlessTheFileSaysElse) {
    const auto folder = project_path("config/schedules");
    const ColumnAddressing sensor{ColumnAddressing::Kind::kGroup, 16, 8, 2};
    const auto made = [&](const std::vector<std::string>& overrides) {
        Config config(folder / "hardware_tiled.toml", overrides);
        NamedSchedule schedule = read_schedule(config, kShape, kSeed, sensor);
        config.reject_unknown_keys();
        return schedule;
    };
    const auto designed = [](HardwareTile tile) {
        tile.array_cols = kShape.cols;
        return hardware_tiled_schedule(tile, kPaperExposureSlots, kSeed);
    };
    EXPECT_EQ(made({}).name, "hardware_tiled");
    EXPECT_EQ(made({}).schedule, designed({.addressing = sensor}));
    EXPECT_EQ(made({"addressing=skip_channel"}).schedule,
              designed({.addressing = {.channels = 16}}));
    EXPECT_EQ(made({"channels=4", "group_cols=2", "group_rows=1"}).schedule,
              designed({.addressing = {ColumnAddressing::Kind::kGroup, 4, 2, 1}}));
    EXPECT_EQ(made({"arrangement=scatter", "tile_rows=4", "tile_cols=16"}).schedule,
              designed({.addressing = sensor,
                        .tile_rows = 4,
                        .tile_cols = 16,
                        .arrangement = TileArrangement::kScatter}));
    EXPECT_EQ(read("hardware_tiled").schedule, designed({}));
}

TEST(ScheduleCatalogueTest, NamesTheKeyThatIsWrong) {
    expect_parts(problem_of("random", {"kind=radnom"}), {"kind", "radnom", "tiled"});
    expect_parts(problem_of("random", {"exposure_slots=[1,65]"}), {"exposure_slots", "65"});
    expect_parts(problem_of("random", {"exposure_slots=[0]"}), {"exposure_slots", "0"});
    expect_parts(problem_of("tiled", {"exposure_slots=[]"}), {"exposure_slots", "give 1 to 255"});
    expect_parts(problem_of("tiled", {"tile_rows=0"}), {"tile_rows", "1..256"});
    expect_parts(problem_of("tiled", {"tile_cols=257"}), {"tile_cols", "1..256"});
    expect_parts(problem_of("hardware_tiled", {"addressing=skip"}), {"addressing", "group"});
    expect_parts(problem_of("hardware_tiled", {"channels=0"}), {"channels", "1..4096"});
    expect_parts(problem_of("hardware_tiled", {"group_cols=0"}), {"group_cols", "1..65535"});
    expect_parts(problem_of("hardware_tiled", {"tile_rows=-1"}), {"tile_rows", "0..16384"});
    expect_parts(problem_of("hardware_tiled", {"arrangement=even"}), {"arrangement", "lattice"});
    expect_parts(problem_of("hardware_tiled", {"exposure_slots=[64,64,64,64,64,64,64,64,64]"}),
                 {"exposure_slots", "576", "512"});
    expect_parts(problem_of("full4x", {"open_slots=5"}), {"open_slots", "period_slots"});
    expect_parts(problem_of("full4x", {"open_slots=65"}), {"open_slots", "1..64"});
    expect_parts(problem_of("full4x", {"period_slots=65536"}), {"period_slots", "1..65535"});
    expect_parts(problem_of("full4x", {"name=" + std::string(65, 'x')}), {"name", "64"});
    expect_parts(problem_of("full4x", {"name=a\x1b[31m"}), {"name", "control characters"});
    expect_parts(problem_of("full4x", {"name=\xff"}), {"name", "UTF-8"});
}

/// Name, compression (period / samples), light throughput, charge stores of each file, by hand.
TEST(ScheduleCatalogueTest, HoldsThePublishedSchedulesWithTheirFigures) {
    struct Published {
        const char* name;
        double samples_per_slot;
        double light;
        int stores;
    };
    for (const auto& [name, samples, light, stores] : {
             Published{"alternating", 1 / 4.0, 5 / 8.0, 1},
             Published{"coded_rolling_shutter_exposure", 1 / 4.0, 7 / 12.0, 1},
             Published{"coded_rolling_shutter_staggered", 1 / 4.0, 1, 1},
             Published{"dol", 1 / 4.0, 1, 1},
             Published{"flexible_voxels", 1 / 16.0, 1 / 16.0, 1},
             Published{"full1x", 1 / 4.0, 1 / 4.0, 1},
             Published{"full4x", 1 / 4.0, 1, 1},
             Published{"global_flutter", 1 / 8.0, 1 / 2.0, 1},
             Published{"multi_phase_2x2", (1 / 2.0 + 1 / 4.0 + 1 / 4.0 + 1 / 8.0) / 4, 1, 1},
             Published{"nd_mosaic", 1 / 4.0, 1, 1},
             Published{"pixel_flutter", 1 / 8.0, 1 / 2.0, 1},
             Published{"random", 4 / 15.0, 1, 1},
             Published{"random_subset", 4 / 16.0, 4 / 16.0, 1},
             Published{"rolling", 1 / 4.0, 1, 1},
             Published{"single_bump", 1 / 8.0, 3 / 8.0, 1},
             Published{"spatially_varying_exposure", 1 / 8.0, 15 / 32.0, 1},
             Published{"tiled", 4 / 15.0, 1, 1},
             Published{"two_bucket", 2 / 8.0, 1, 2},
         }) {
        const NamedSchedule found = read(name);
        EXPECT_EQ(found.name, name);
        EXPECT_DOUBLE_EQ(found.schedule.samples_per_pixel_slot(), samples) << name;
        EXPECT_DOUBLE_EQ(found.schedule.light_throughput(), light) << name;
        EXPECT_EQ(found.schedule.charge_stores(), stores) << name;
    }
}

TEST(ScheduleCatalogueTest, ReadsTheKeysOfEveryKind) {
    EXPECT_EQ(read("flexible_voxels", {"tile_rows=1", "tile_cols=2", "exposure_slots=[1,2]",
                                       "every_slots=3", "first_slots=[0,1]"})
                  .schedule,
              ExposureSchedule(1, 2, 3, {0, 1, 2}, {{0, 1}, {1, 0b11}}));
    EXPECT_EQ(read("rolling", {"exposure_slots=2", "period_slots=3", "rows_per_slot=5"}).schedule,
              rolling_schedule({2, 3, 5}, 12));
    EXPECT_EQ(read("rolling").schedule, rolling_schedule({4, 4, 3}, 12));  // 12 rows in 4 slots
    const int lengths[] = {1, 5};
    EXPECT_EQ(read("single_bump", {"tile_rows=2", "tile_cols=3", "exposure_slots=[1,5]",
                                   "period_slots=9", "wrap=true"})
                  .schedule,
              scattered_schedule({2, 3, 9, true}, lengths, kSeed));
    EXPECT_EQ(read("global_flutter", {"tile_rows=2", "tile_cols=3", "code_slots=9", "open_slots=2",
                                      "codes=2", "complement=true"})
                  .schedule,
              flutter_schedule({2, 3, 9, 2, 2, true}, kSeed));
}

TEST(ScheduleCatalogueTest, NamesTheKeyOfASettingThatNoPixelCanDo) {
    expect_parts(problem_of("flexible_voxels", {"first_slots=[1,2]"}),
                 {"first_slots", "2 values", "16 pixels"});
    expect_parts(problem_of("multi_phase_2x2", {"exposure_slots=[2,4,5,8]"}),
                 {"every_slots", "pixel (1, 0)", "5 slots every 4"});
    expect_parts(problem_of("rolling", {"exposure_slots=5"}), {"exposure_slots", "5 slots of 4"});
    expect_parts(problem_of("single_bump", {"exposure_slots=[9]"}), {"exposure_slots", "period"});
    expect_parts(problem_of("two_bucket", {"open_slots=8"}), {"open_slots", "complement"});
    expect_parts(problem_of("pixel_flutter", {"tile_rows=256", "tile_cols=256", "codes=8000"}),
                 {"codes", "2^24"});
}

TEST(ScheduleCatalogueTest, RefusesKeysOfAnotherKind) {
    expect_parts(problem_of("random", {"tile_rows=16"}), {"tile_rows", "unknown"});
    expect_parts(problem_of("full4x", {"exposure_slots=[1]"}), {"exposure_slots", "unknown"});
}

TEST(ScheduleCatalogueTest, SendsArraysTooLargeForRandomToTiled) {
    const FrameShape large{.rows = 4320, .cols = 7680, .planes = 1};
    expect_parts(problem_of("random", {}, large), {"7680 x 4320", "schedule = tiled"});
    EXPECT_NO_THROW(read("tiled", {}, large));
}

TEST(ScheduleCatalogueTest, FullScheduleRefusesMoreOpenSlotsThanThereAre) {
    EXPECT_THROW(static_cast<void>(full_schedule(0, 4)), InputError);
    EXPECT_THROW(static_cast<void>(full_schedule(5, 4)), InputError);
    EXPECT_THROW(static_cast<void>(full_schedule(65, 100)), InputError);
    EXPECT_EQ(full_schedule(64, 64).light_throughput(), 1.0);
}

}  // namespace
}  // namespace stipple
