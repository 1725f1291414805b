#include "decoder/live_preview.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

const ExposureSchedule kEverySlot{1, 1, 1, {0, 1}, {{.first_slot = 0, .open_slots = 1}}};

FluxVideo uniform_video() {
    FluxVideo video(20, {.rows = 32, .cols = 32, .planes = 1});
    std::ranges::fill(video.data(), 0.5F);
    return video;
}

/// Of the first 12 slots.
constexpr int kShownSlot = 6;

class LivePreviewTest : public ::testing::Test {
  protected:
    static PreviewOptions options(DecodeMethod method = DecodeMethod::kNaive) {
        return {.method = method, .size = {}};
    }
    /// Hands over all slots of the recording; a slot is a packet.
    void add_all(LivePreview& preview) const {
        for (const SamplePacket& packet : recorded_.packets) preview.add({&packet, 1}, 0);
    }

    Recorded recorded_ = record(uniform_video(), kEverySlot);
};

// A pixel's 500 electrons have a noise of sqrt(500 + 10^2) = 24.5 electrons, 0.0245 of light; the
// mean of 1024 pixels a 32nd of that, of which 5 are allowed.
TEST_F(LivePreviewTest, AFrameIsShownThatHasTheLightOfItsSlot) {
    std::counting_semaphore<> shown{0};
    PreviewFrame frame;
    LivePreview preview(recorded_.header, options(),
                        {.show =
                             [&](const PreviewFrame& made) {
                                 if (frame.light.empty()) frame = made;
                                 shown.release();
                             },
                         .tell = [](const Message& what) { FAIL() << what.text(); },
                         .keep_going = [] { return true; }});
    add_all(preview);
    shown.acquire();
    preview.finish([] {});
    EXPECT_EQ(frame.slot, kShownSlot);
    EXPECT_EQ(frame.shape, recorded_.header.shape);
    EXPECT_NEAR(frame.mean_light(), 0.5, 5 * 0.0245 / 32);
    EXPECT_GE(preview.counts().made, 1);
    EXPECT_EQ(preview.counts().failed, 0);
}

TEST_F(LivePreviewTest, SlotsPassByWhileAFrameIsMade) {
    std::binary_semaphore all_added{0};
    LivePreview preview(recorded_.header, options(),
                        {.show = [&](const PreviewFrame&) { all_added.acquire(); },
                         .tell = [](const Message& what) { FAIL() << what.text(); },
                         .keep_going = [] { return true; }});
    add_all(preview);
    all_added.release();
    preview.finish([] {});
    const PreviewCounts counts = preview.counts();
    EXPECT_EQ(counts.made, 1);
    EXPECT_EQ(counts.last_slot, kShownSlot);
    EXPECT_EQ(counts.skipped_slots, static_cast<std::int64_t>(recorded_.packets.size()) -
                                        PreviewDecoder(recorded_.header, options()).slots());
}

TEST_F(LivePreviewTest, OfFewerSlotsThanAWindowThereIsOneFrame) {
    int shown = 0;
    LivePreview preview(recorded_.header, options(DecodeMethod::kLive),
                        {.show =
                             [&](const PreviewFrame& made) {
                                 EXPECT_NEAR(made.mean_light(), 0.5, 5 * 0.0245 / 32);
                                 ++shown;
                             },
                         .tell = [](const Message& what) { FAIL() << what.text(); },
                         .keep_going = [] { return true; }});
    add_all(preview);  // 20 slots
    preview.finish([] {});
    EXPECT_EQ(shown, 1);
    EXPECT_EQ(preview.counts().last_slot, 11);
    EXPECT_EQ(preview.counts().skipped_slots, 0);
}

// How many slots come until a frame is ready is not known; each frame has the bits of its slots.
TEST_F(LivePreviewTest, AFrameOfTheMethodLiveIsDecodedFromTheSlotsOfItsWindow) {
    recorded_ = record(random_video(200, {.rows = 32, .cols = 32, .planes = 1}, 1), kEverySlot);
    PreviewDecoder reference(recorded_.header, options(DecodeMethod::kLive));
    std::vector<PreviewFrame> frames;
    LivePreview preview(recorded_.header, options(DecodeMethod::kLive),
                        {.show = [&](const PreviewFrame& made) { frames.push_back(made); },
                         .tell = [](const Message& what) { FAIL() << what.text(); },
                         .keep_going = [] { return true; }});
    for (const SamplePacket& packet : recorded_.packets) {
        preview.add({&packet, 1}, 0);
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    preview.finish([] {});
    ASSERT_GE(frames.size(), 1U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const PreviewFrame& frame = frames[i];
        EXPECT_EQ(frame.light, reference
                                   .decode(reference.newest(frame.slot + 9), recorded_.packets,
                                           [](double) { return true; })
                                   ->light);
        if (i > 0) {
            EXPECT_GE(frame.slot, frames[i - 1].slot + 8);
        }
    }
}

TEST(PreviewDecoderTest, DecodesByNaiveWhatAWindowOfLiveHasNoSampleOf) {
    const auto method = [](int period) {
        const ExposureSchedule rare(1, 1, period, {0, 1}, {{.first_slot = 0, .open_slots = 1}});
        const Recorded recorded = record(uniform_video(), rare);
        return PreviewDecoder(recorded.header, {.method = DecodeMethod::kLive, .size = {}})
            .method();
    };
    EXPECT_EQ(method(16), DecodeMethod::kLive);
    EXPECT_EQ(method(17), DecodeMethod::kNaive);
}

TEST_F(LivePreviewTest, AFailureIsToldOnceAndCounted) {
    std::counting_semaphore<> tried{0};
    int told = 0;
    LivePreview preview(recorded_.header, options(),
                        {.show =
                             [&](const PreviewFrame&) {
                                 tried.release();
                                 throw std::runtime_error("no space");
                             },
                         .tell =
                             [&](const Message& what) {
                                 EXPECT_EQ(what.text(), "no space");
                                 ++told;
                             },
                         .keep_going = [] { return true; }});
    for (int made = 0; made < 2;) {
        add_all(preview);
        if (tried.try_acquire()) ++made;
    }
    preview.finish([] {});
    EXPECT_EQ(preview.counts().made, 0);
    EXPECT_GE(preview.counts().failed, 2);
    EXPECT_EQ(told, 1);
}

}  // namespace
}  // namespace stipple
