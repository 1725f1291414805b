#include "session/decode_session.h"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "calibration/calibration_file.h"
#include "core/error.h"
#include "io/npy_file.h"
#include "readout/schedules/tiled_schedule.h"
#include "session/video_shards.h"
#include "tests/decoder/recordings.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/paper_schedule.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 24, .planes = 1};

class DecodeSessionTest : public testing::Test {
  protected:
    /// A stream of `slots` slots. Returns its header.
    StreamHeader write_stream(int slots) {
        const Recorded recorded =
            record(random_video(slots, kShape, 1), tiled_schedule(8, 8, kPaperExposureSlots, 1));
        write_text(file_, bytes_of(recorded.header, recorded.packets).bytes);
        return recorded.header;
    }
    void write_calibration(const StreamHeader& header, float offset_dn) {
        ChipCalibration calibration{.shape = header.shape,
                                    .bit_depth = header.calibration.bit_depth,
                                    .tile_rows = header.calibration.tile.rows,
                                    .tile_cols = header.calibration.tile.cols,
                                    .chip = {},
                                    .sites = std::vector<SiteCalibration>(header.shape.sites())};
        for (SiteCalibration& site : calibration.sites) site.offset_dn = offset_dn;
        const auto bytes = encode_chip_calibration(calibration);
        write_text(folder_ / "a.stcal",
                   {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    static std::vector<float> frames_of(DecodeSession session) {
        std::vector<float> frames;
        session.run([&](std::int64_t, std::span<const float> frame) {
            frames.insert(frames.end(), frame.begin(), frame.end());
            return true;
        });
        return frames;
    }
    static DecodeSetup naive() {
        return read_decode_setup("naive", Config(std::vector<std::string>{}));
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.stipple";
};

TEST_F(DecodeSessionTest, HasTheBitsOfDecode) {
    write_stream(100);
    std::vector<float> expected;
    StreamReader reader(file_);
    decode(reader, DecodeMethod::kNaive, [&](std::int64_t, std::span<const float> frame) {
        expected.insert(expected.end(), frame.begin(), frame.end());
        return true;
    });
    EXPECT_EQ(frames_of(DecodeSession(file_, naive())), expected);
    EXPECT_EQ(frames_of(DecodeSession(StreamReader(file_), naive())), expected);

    DecodeSession first(file_, naive());
    EXPECT_EQ(first.frames(), 100);
    first.end_after(30);
    EXPECT_EQ(first.frames(), 30);
    expected.resize(30 * kShape.sites());
    EXPECT_EQ(frames_of(std::move(first)), expected);
}

TEST_F(DecodeSessionTest, TheCalibrationBesideTheStreamIsUsedUnlessAnotherIsChosen) {
    const StreamHeader header = write_stream(20);
    const std::vector<float> plain = frames_of(DecodeSession(file_, naive()));
    write_calibration(header, 3);
    const std::vector<float> calibrated = frames_of(DecodeSession(file_, naive()));
    EXPECT_NE(calibrated, plain);
    EXPECT_EQ(frames_of(DecodeSession(file_, naive(), folder_ / "a.stcal")), calibrated);
    EXPECT_EQ(frames_of(DecodeSession(file_, naive(), calibration_choice("none"))), plain);
}

TEST_F(DecodeSessionTest, WindowsHaveTheFramesOfTheWholeStream) {
    write_stream(100);
    const std::vector<float> whole = frames_of(DecodeSession(file_, naive()));
    const ShardedDecoding decoding{.stream = file_, .setup = naive()};
    VideoShards folder(folder_ / "windows", identity_of(decoding, [] {}));
    ASSERT_EQ(folder.count(), 2);
    EXPECT_FALSE(folder.claimed());
    EXPECT_EQ(folder.windows().missing({0, 2}), (std::vector<std::int64_t>{0, 1}));
    const auto stopped = decode_windows(folder, decoding, {0, 2},
                                        [](double, std::int64_t frames) { return frames < 48; });
    EXPECT_FALSE(stopped);
    EXPECT_EQ(folder.windows().missing({0, 2}), (std::vector<std::int64_t>{1}));
    EXPECT_TRUE(
        decode_windows(folder, decoding, {1, 2}, [](double, std::int64_t) { return true; }));
    folder.require_all();
    std::vector<double> joined = read_npy_volume(folder.window(0)).values;
    const std::vector<double> rest = read_npy_volume(folder.window(1)).values;
    joined.insert(joined.end(), rest.begin(), rest.end());
    EXPECT_EQ(std::vector<float>(joined.begin(), joined.end()), whole);
}

TEST_F(DecodeSessionTest, AStreamWithoutASlotIsRefused) {
    write_stream(1);
    DecodeSession session(file_, naive());
    EXPECT_EQ(session.warnings(), std::vector<Message>{});
    EXPECT_NO_THROW(frames_of(std::move(session)));
    const Recorded recorded =
        record(random_video(8, kShape, 1), tiled_schedule(8, 8, kPaperExposureSlots, 1));
    write_text(file_, bytes_of(recorded.header, {}).bytes);
    EXPECT_THROW(frames_of(DecodeSession(file_, naive())), InputError);
    DecodeSession stopped(file_, naive());  // as a signal stops the wait for a growing stream
    const auto no_frame = [](std::int64_t, std::span<const float>) { return true; };
    EXPECT_EQ(stopped.run(no_frame, [](double) { return false; }).slots, 0);
}

}  // namespace
}  // namespace stipple
