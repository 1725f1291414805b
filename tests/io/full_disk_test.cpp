#include <gtest/gtest.h>

#include <cstdint>

#include "core/error.h"
#include "io/frame_writer.h"
#include "io/image_file.h"
#include "io/output_file.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/noise.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

TEST(FullDiskTest, EveryVideoFormatReportsItAndLeavesNothingBehind) {
    const FrameShape shape{64, 64, 3};
    for (const char* name : {"clip.npy", "frames", "clip.mp4", "clip.mkv", "clip.tif"})
        for (const rlim_t limit : {0U, 20000U}) {
            const TemporaryFolder folder;
            const FileSizeLimit full_disk(limit);
            const auto message = message_of<DeviceError>([&] {
                FrameWriter writer(folder / name, shape);
                for (std::uint32_t seed = 0; seed < 20; ++seed)
                    writer.write(noise(shape.sites(), seed));  // no codec makes it small
                writer.finish();
            });
            expect_parts(message, {(folder / name).string()});
            EXPECT_EQ(message.find("partial"), std::string::npos) << message;
            EXPECT_EQ(folder.names(), std::vector<std::string>{}) << name;
        }
}

TEST(FullDiskTest, AFailureOfTheLastBytesIsReportedOnClose) {
    OutputFile file("/dev/full", "clip.npy");
    file.write(std::as_bytes(std::span("small", 5)));
    expect_parts(message_of<DeviceError>([&] { file.close(); }),
                 {"clip.npy: cannot be written: No space left on device; free space"});
}

TEST(FullDiskTest, AImageReportsIt) {
    expect_parts(message_of<DeviceError>([] {
                     write_png("/dev/full", "a.png", {1, 1, 1}, Floats{1});
                 }),
                 {"a.png: cannot be written: No space left on device; free space"});
}

}  // namespace
}  // namespace stipple
