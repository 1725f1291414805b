#include "capture/recording/resampled_footage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

constexpr double kSlotUs = 1000;

/// A recording of `count` frames; a recording declares no rate and no number of frames beforehand.
class ResampledFootageTest : public testing::Test {
  protected:
    ReadAhead footage(int count, const char* format = "Mono8", int width = 12, int height = 5) {
        std::vector<CapturedFrame> frames;
        for (int i = 0; i < count; ++i)
            frames.push_back(test_frame(static_cast<std::uint64_t>(i), format, width, height));
        write_recording(file_, frames);
        return ReadAhead(file_, {}, [](const Message&) {});
    }

    static std::vector<Floats> read_all(ResampledFootage& slots) {
        std::vector<Floats> all;
        for (auto slot = slots.next(); !slot.empty(); slot = slots.next())
            all.emplace_back(slot.begin(), slot.end());
        return all;
    }

    const TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "a.strec";
};

TEST_F(ResampledFootageTest, EachFrameIsASlotWithoutAMethod) {
    ReadAhead frames = footage(3);
    ResampledFootage slots(frames, "a", {});
    const auto all = read_all(slots);
    ASSERT_EQ(all.size(), 3U);
    ReadAhead again(file_, {}, [](const Message&) {});
    for (const Floats& slot : all) {
        const auto frame = again.next();
        EXPECT_EQ(slot, Floats(frame.begin(), frame.end()));
    }
}

TEST_F(ResampledFootageTest, SlotsThatAreSkippedAreLeftOut) {
    for (const auto method : {std::optional<Resampling>(), std::optional(Resampling::kBlend)})
        for (int first = 0; first < 7; ++first) {
            const SlotOptions options{
                .method = method, .frames_hz = 0.9e6 / kSlotUs, .slot_us = kSlotUs};
            ReadAhead all_frames = footage(5);
            ResampledFootage all_slots(all_frames, "a", options);
            auto expected = read_all(all_slots);
            expected.erase(expected.begin(), expected.begin() + std::min<std::ptrdiff_t>(
                                                                    first, std::ssize(expected)));
            ReadAhead frames = footage(5);
            ResampledFootage slots(frames, "a", options);
            slots.skip(first);
            EXPECT_EQ(read_all(slots), expected) << first;
        }
}

TEST_F(ResampledFootageTest, FramesOfHalfTheSlotRateAreHeldForTwoSlots) {
    ReadAhead frames = footage(3);
    ResampledFootage slots(
        frames, "a",
        {.method = Resampling::kHold, .frames_hz = 0.5e6 / kSlotUs, .slot_us = kSlotUs});
    EXPECT_FALSE(slots.slots());
    const auto all = read_all(slots);
    ASSERT_EQ(all.size(), 6U);
    for (std::size_t i = 0; i < all.size(); i += 2) EXPECT_EQ(all[i], all[i + 1]);
    EXPECT_NE(all[1], all[2]);
}

TEST_F(ResampledFootageTest, KnowsItsSlotsIfTheFootageDeclaresItsFrames) {
    const auto name = folder_ / "a.raw";
    std::ofstream(name, std::ios::binary) << std::string(4 * 2 * 10, 'x');
    ReadAhead frames(name, {.max_value = {}, .raw = parse_raw_format("4x2:mono8")},
                     [](const Message&) {});
    ResampledFootage slots(frames, "a",
                           {.method = Resampling::kBlend, .frames_hz = 2500, .slot_us = kSlotUs});
    EXPECT_EQ(slots.slots(), 4);  // 10 frames are 4 ms
    EXPECT_EQ(read_all(slots).size(), 4U);
}

TEST_F(ResampledFootageTest, AnUnknownRateIsRefused) {
    ReadAhead frames = footage(2);
    const auto blend = [&] {
        const ResampledFootage slots(frames, "a.strec",
                                     {.method = Resampling::kBlend, .slot_us = kSlotUs});
    };
    EXPECT_THAT(blend, testing::ThrowsMessage<InputError>(
                           testing::HasSubstr("a.strec: does not declare its frame rate")));
}

TEST_F(ResampledFootageTest, FlowOfAMosaicIsRefused) {
    ReadAhead frames = footage(2, "BayerRG8", 12, 4);
    const SlotOptions options{.method = Resampling::kFlow, .frames_hz = 500, .slot_us = kSlotUs};
    const auto flow = [&] { const ResampledFootage slots(frames, "a", options); };
    EXPECT_THAT(flow, testing::ThrowsMessage<InputError>(testing::HasSubstr("mosaic")));
}

TEST_F(ResampledFootageTest, FramesThatAreTooSmallForTheFlowAreBlended) {
    for (const int height : {5, 4}) {
        ReadAhead frames = footage(3, "Mono8", 12, height);
        int calls = 0;
        ResampledFootage slots(frames, "a",
                               {.method = Resampling::kFlow,
                                .frames_hz = 500,
                                .slot_us = kSlotUs,
                                .flow =
                                    [&](auto, auto, std::span<float> flow) {
                                        ++calls;
                                        std::ranges::fill(flow, 0.0F);
                                    },
                                .min_flow_side = 5});
        EXPECT_EQ(read_all(slots).size(), 6U);
        EXPECT_EQ(calls > 0, height == 5);
    }
}

}  // namespace
}  // namespace stipple
