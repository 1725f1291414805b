// Runs in the virtual machine of tests/vm/boot.py, on vivid as tests/vm/vivid loads it: the bytes
// of frames, against v4l2-ctl and against what was sent into a loop.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "capture/v4l2/v4l2_settings.h"
#include "core/error.h"
#include "core/philox.h"
#include "tests/vm/loop_writer.h"
#include "tests/vm/vivid_camera.h"

namespace stipple {
namespace {

void shell(const std::string& command) {
    if (std::system((command + " >/dev/null 2>/run/stderr").c_str()) != 0)
        throw std::runtime_error(command + " failed");
}

std::vector<std::uint8_t> file_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// As v4l2-ctl takes it.
std::string fourcc_text(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(code >> (8 * i) & 0x7FU);
    return (code >> 31U) != 0 ? text + "-BE" : text;
}

TEST(VividStreamTest, EveryRawFormatHasTheBytesThatV4l2CtlGets) {
    const auto names = v4l2_format_names(V4l2Device("/dev/video0"));
    EXPECT_GE(names.size(), 2);
    for (const auto& name : names) {
        auto camera = open_video(0, still({{"PixelFormat", name}}));
        camera->start();
        const CapturedFrame ours = frame_from(*camera);
        camera.reset();
        EXPECT_EQ(ours.record.status, FrameStatus::kComplete);
        open_video(0, {{"Width", "640"}, {"Height", "360"}});  // v4l2-ctl sets all by itself
        const std::string fourcc = fourcc_text(ours.record.layout.format->v4l2);
        shell("v4l2-ctl -d0 --set-fmt-video=width=320,height=180,pixelformat='" + fourcc +
              "' --stream-mmap --stream-count=1 --stream-to=/run/frame");
        EXPECT_EQ(ours.payload, file_bytes("/run/frame")) << name;
    }
}

TEST(VividStreamTest, AllWaysToGetFramesGiveTheSameBytes) {
    for (const auto& name : v4l2_format_names(V4l2Device("/dev/video1"))) {
        std::vector<std::uint8_t> first;
        for (const int number : {0, 1})
            for (const char* const memory : {"driver", "own"}) {
                const auto camera =
                    open_video(number, still({{"PixelFormat", name}, {"BufferMemory", memory}}), 2);
                EXPECT_EQ(camera->description().transport_facts.at("api"),
                          number == 1 ? "multi-planar" : "single-planar");
                camera->start();
                for (int i = 0; i < 3; ++i) {
                    const auto payload = frame_from(*camera).payload;
                    if (first.empty()) first = payload;
                    EXPECT_EQ(payload, first) << name << " of video" << number << ", " << memory;
                }
            }
    }
}

TEST(VividStreamTest, RefusesWhatTheDriverWouldReplace) {
    EXPECT_THROW(open_video(0, {{"Input", "0"}, {"Width", "333"}}), InputError);
    EXPECT_THROW(open_video(0, still({{"AcquisitionFrameRate", "200"}})), InputError);
    EXPECT_THROW(open_video(0, {{"Input", "7"}}), InputError);
    EXPECT_THROW(open_video(3, {}), DeviceError);  // an output
    const auto camera = open_video(0, still({{"AcquisitionFrameRate", "30"}}));
    EXPECT_THROW(open_video(0, still()), DeviceError);  // in use
}

TEST(VividStreamTest, StampsAreMonotonicAndSayOfWhat) {
    const std::vector<std::pair<const char*, StampSource>> cases{
        {"0", StampSource::kHostEndOfFrame}, {"1", StampSource::kHostStartOfFrame}};
    for (const auto& [source, expected] : cases) {
        const auto camera = open_video(0, still({{"timestamp_source", source}}));
        camera->start();
        const auto first = frame_from(*camera).record;
        const auto second = frame_from(*camera).record;
        EXPECT_EQ(first.stamp_source, expected);
        EXPECT_LT(first.device_ns, second.device_ns);
        EXPECT_LT(first.host_monotonic_ns, second.host_monotonic_ns);
    }
    control(0, "timestamp_source", "0");
}

void set_timings(int number, int fps) {
    shell("v4l2-ctl -d" + std::to_string(number) +
          " --set-dv-bt-timings cvt,width=640,height=480,fps=" + std::to_string(fps));
}

TEST(VividStreamTest, ARegionHoldsThePixelsOfItsPlace) {
    shell("v4l2-ctl -d0 --set-input 1");
    set_timings(0, 60);
    const auto image = [](const CameraSettings& region) {
        CameraSettings settings{{"PixelFormat", "Mono8"}, {"osd_text_mode", "2"},
                                {"test_pattern", "20"},   {"OffsetX", "0"},
                                {"OffsetY", "0"},         {"Width", "640"},
                                {"Height", "480"}};
        settings.insert(settings.end(), region.begin(), region.end());
        const auto camera = open_video(0, settings);
        camera->start();
        return frame_from(*camera);
    };
    const CapturedFrame whole = image({});
    const CapturedFrame part =
        image({{"OffsetX", "64"}, {"OffsetY", "32"}, {"Width", "320"}, {"Height", "240"}});
    EXPECT_EQ(part.record.layout.offset_x, 64);
    EXPECT_EQ(part.record.layout.offset_y, 32);
    for (std::size_t row = 0; row < 240; ++row) {
        const auto* const expected =
            whole.payload.data() + (row + 32) * whole.record.layout.stride_bytes + 64;
        const auto* const got = part.payload.data() + row * part.record.layout.stride_bytes;
        ASSERT_TRUE(std::equal(got, got + 320, expected)) << row;
    }
    static_cast<void>(image({}));  // leaves the whole sensor behind
}

/// Noise, each frame different from the others, with its number in its first four bytes.
std::vector<std::vector<std::uint8_t>> noise_frames(std::size_t bytes, std::uint32_t count) {
    std::vector<std::vector<std::uint8_t>> frames(count, std::vector<std::uint8_t>(bytes));
    for (std::uint32_t n = 0; n < count; ++n) {
        for (std::size_t i = 0; i < bytes; i += 16) {
            const auto words = philox4x32({static_cast<std::uint32_t>(i), n, 0, 0}, 1);
            std::memcpy(frames[n].data() + i, words.data(), std::min<std::size_t>(16, bytes - i));
        }
        std::memcpy(frames[n].data(), &n, sizeof n);
    }
    return frames;
}

TEST(VividStreamTest, TheLoopFromAnOutputIsBitExact) {
    constexpr std::uint32_t kFrames = 32;
    constexpr std::size_t kDistinct = 16;
    for (const auto* const name : {"Mono8", "Mono16", "BayerRG12", "RGB8"}) {
        const PixelFormat* const format = pixel_format_named(name);
        if (format == nullptr) continue;
        set_timings(2, 50);
        set_timings(3, 50);
        const auto camera =
            open_video(2, {{"PixelFormat", name}, {"loop_video", "1"}, {"osd_text_mode", "2"}}, 8);
        const LoopWriter writer("/dev/video3", format->v4l2, 640, 480,
                                noise_frames(camera->layout().payload_bytes(), kFrames));
        const auto frames = noise_frames(camera->layout().payload_bytes(), kFrames);
        camera->start();
        std::set<std::uint32_t> seen;
        int others = 0;
        for (int i = 0; i < 500 && seen.size() < kDistinct; ++i) {
            const CapturedFrame frame = frame_from(*camera);
            std::uint32_t number = 0;
            std::memcpy(&number, frame.payload.data(), sizeof number);
            if (number < kFrames && frame.payload == frames[number])
                seen.insert(number);
            else if (!seen.empty())
                ++others;  // before the first one of ours vivid sends noise of its own
        }
        EXPECT_EQ(seen.size(), kDistinct) << name;
        EXPECT_EQ(others, 0) << name;
    }
}

}  // namespace
}  // namespace stipple
