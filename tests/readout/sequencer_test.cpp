#include "readout/sequencer.h"

#include <gtest/gtest.h>

#include "tests/readout/gapped_schedule.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 7, .cols = 23, .planes = 1};

/// 1 where an exposure that began in slot 0 or later collects light, by the definition; 2 where it
/// does so in the second store.
std::vector<std::uint8_t> open_by_definition(const ExposureSchedule& schedule, int slot, int row) {
    std::vector<std::uint8_t> open;
    const int tile_row = row % schedule.tile_rows();
    for (int col = 0; col < kShape.cols; ++col) {
        open.push_back(0);
        const int tile_col = col % schedule.tile_cols();
        const auto exposures = schedule.exposures(tile_row, tile_col);
        for (std::size_t i = 0; i < exposures.size(); ++i)
            for (int n = 0; n <= slot / schedule.period_slots(); ++n) {
                const Exposure& e = exposures[i];
                const int age = slot - n * schedule.period_slots() - static_cast<int>(e.first_slot);
                if (age >= 0 && age < e.span_slots() && (e.open_slots >> age & 1U) != 0)
                    open.back() =
                        static_cast<std::uint8_t>(1 + schedule.store(tile_row, tile_col, i, n));
            }
    }
    return open;
}

void expect_open_as_defined(const ExposureSchedule& schedule) {
    const Sequencer sequencer(schedule, kShape);
    std::vector<std::uint8_t> open(static_cast<std::size_t>(kShape.cols));
    for (int slot = 0; slot < 3 * schedule.period_slots(); ++slot) {
        bool all = true;
        for (int row = 0; row < kShape.rows; ++row) {
            sequencer.list_open(slot, row, open);
            ASSERT_EQ(open, open_by_definition(schedule, slot, row)) << slot << " row " << row;
            for (const std::uint8_t pixel : open) all = all && pixel != 0;
        }
        ASSERT_TRUE(all || !sequencer.all_open(slot)) << "slot " << slot;
    }
}

TEST(SequencerTest, OpensThePixelsThatTheScheduleSays) {
    expect_open_as_defined(random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
    for (const std::uint32_t seed : {1U, 2U, 3U})
        expect_open_as_defined(gapped_schedule(3, 5, 29, seed));
    expect_open_as_defined(gapped_schedule(16, 32, 17, 4));  // a tile larger than the array
}

TEST(SequencerTest, SaysThatAllAreOpenOnceTheFirstExposuresAreOver) {
    const auto schedule = random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    const Sequencer sequencer(schedule, kShape);
    EXPECT_FALSE(sequencer.all_open(6));
    EXPECT_TRUE(sequencer.all_open(7));  // the longest exposure has 8 slots
    const ExposureSchedule gapped(1, 1, 4, {0, 1}, {{0, 1}});
    EXPECT_FALSE(Sequencer(gapped, kShape).all_open(1000));
}

TEST(SequencerTest, ReadsInScanOrder) {
    const ExposureSchedule schedule(2, 2, 2, {0, 1, 2, 3, 4}, {{0, 1}, {1, 1}, {1, 1}, {0, 1}});
    const Sequencer sequencer(schedule, {.rows = 2, .cols = 5, .planes = 1});
    std::vector<std::uint32_t> pixels;
    sequencer.append_due(2, 0, pixels);
    sequencer.append_due(2, 1, pixels);
    EXPECT_EQ(pixels, (std::vector<std::uint32_t>{0, 2, 4, 6, 8}));
}

TEST(SequencerTest, OpensOneOfTwoStoresWhereExposuresInterleave) {
    expect_open_as_defined(alternating_schedule());
    for (const std::uint32_t seed : {1U, 2U, 3U})
        expect_open_as_defined(interleaved_schedule(3, 5, 9, seed));
}

// The last slot of an exposure is open, so the store that is read is the one that is open.
TEST(SequencerTest, ReadsTheStoreThatCollectedLightLast) {
    for (const auto& schedule : {alternating_schedule(), interleaved_schedule(3, 5, 9, 1)}) {
        const Sequencer sequencer(schedule, kShape);
        std::vector<std::uint8_t> open(static_cast<std::size_t>(kShape.cols)), stores;
        std::vector<std::uint32_t> pixels;
        for (int slot = 0; slot < 3 * schedule.period_slots(); ++slot) {
            pixels.clear();
            stores.clear();
            sequencer.list_open(slot, 0, open);
            sequencer.append_due(slot, 0, pixels);
            sequencer.append_stores(slot, 0, stores);
            ASSERT_EQ(stores.size(), pixels.size());
            for (std::size_t i = 0; i < pixels.size(); ++i)
                ASSERT_EQ(stores[i] + 1, open[pixels[i]]) << "slot " << slot;
        }
    }
}

}  // namespace
}  // namespace stipple
