#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "decoder/block_partition.h"
#include "tests/core/temporary_folder.h"
#include "tests/pipeline/clip.h"

namespace stipple {
namespace {

/// A line of /proc/self/status, in bytes: VmRSS is what lies in RAM, VmHWM the most that ever did.
std::uint64_t status_bytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == key + ':') {
            std::uint64_t kilobytes = 0;
            status >> kilobytes;
            return kilobytes * 1024;
        }
    return 0;
}

/// Forgets the most that ever lay in RAM. False where the system does not let us.
bool reset_peak() {
    return static_cast<bool>(std::ofstream("/proc/self/clear_refs") << "5" << std::flush);
}

/// The most memory that decoding adds to what the process has, in bytes.
std::uint64_t decoding_bytes(const std::filesystem::path& file) {
    StreamReader reader(file);
    reset_peak();
    const std::uint64_t before = status_bytes("VmRSS");
    decode(reader, DecodeMethod::kFast, [](std::int64_t, std::span<const float>) { return true; });
    return status_bytes("VmHWM") - before;
}

TEST(MemoryTest, IsAtMost64BytesAVoxelOfABlockWhateverTheLengthOfTheClip) {
    if (!reset_peak()) GTEST_SKIP() << "/proc/self/clear_refs cannot be written here";
    for (const FrameShape shape : {FrameShape{160, 240, 1}, FrameShape{120, 160, 3}}) {
        FluxVideo video(150, shape);
        for (std::size_t i = 0; i < video.voxels(); ++i)
            video.data()[i] = static_cast<float>((i / 7 + i % 240) % 50) / 50;
        const TemporaryFolder folder;
        write_recording(video, "tiled", folder / "clip.stipple");
        video = {};
        const std::uint64_t block_voxels =
            (kCoreSlots + 2 * kHaloSlots) * shape.sites();  // of the second of its three blocks
        EXPECT_LE(decoding_bytes(folder / "clip.stipple"), 64 * block_voxels);
    }
}

}  // namespace
}  // namespace stipple
