#include <gtest/gtest.h>
#include <malloc.h>

#include <cstdint>
#include <fstream>
#include <string>

#include "decoder/block_partition.h"
#include "decoder/decode_method.h"
#include "decoder/decode_options.h"
#include "readout/schedules/tiled_schedule.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

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
std::uint64_t decoding_bytes(const std::filesystem::path& file, DecodeMethod method) {
    StreamReader reader(file);
    reset_peak();
    const std::uint64_t before = status_bytes("VmRSS");
    DecodeOptions options = options_of(method);
    for (MotionTvOptions* fast : {&options.fast, &options.best.start})  // more take no more
        fast->static_tv.iterations = fast->along_motion.iterations = fast->last_iterations = 2;
    options.best.iterations = 2;
    options.hitomi2011.dictionary = cosine_dictionary({.slots = 8, .side_px = 4}, 3);
    options.hitomi2011.step_px = 4;
    options.hitomi2011.max_atoms = 2;
    options.reddy2011.first_iterations = options.reddy2011.iterations = 2;
    options.bennett2005.radius_px = 1;
    options.zhang2009.step_px = 6;
    options.vbm4d.step_px = 8;
    options.vbm4d.search_px = 1;
    options.vbm4d.max_volumes = 2;
    decode(reader, options, [](std::int64_t, std::span<const float>) { return true; });
    return status_bytes("VmHWM") - before;
}

/// Has glibc give freed arrays of a megabyte and more back to the system, as it always does from
/// 32 MiB on: the arrays of these small blocks are to count only while they are in use.
void return_freed_arrays() {
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
}

/// 16 exposures of 1 slot, then one of 2, 3 and 4 slots.
ExposureSchedule four_times() {
    std::vector<Exposure> exposures;
    for (std::uint32_t slot = 0; slot < 16; ++slot) exposures.push_back({slot, 1});
    exposures.insert(exposures.end(), {{16, 0b11}, {18, 0b111}, {21, 0b1111}});
    return {1, 1, 25, {0, 19}, exposures};
}

/// Records and decodes so many slots of a chequered scene; the bytes that decoding takes.
std::uint64_t decode_scene(int slots, FrameShape shape, DecodeMethod method) {
    const TemporaryFolder folder;
    FluxVideo video(slots, shape);
    for (std::size_t i = 0; i < video.voxels(); ++i)
        video.data()[i] = static_cast<float>((i / 7 + i % 240) % 50) / 50;
    // A frame in each slot is what takes most of a conventional camera's memory; of alternating
    // exposure times, most frames of 1 slot and few of three others.
    if (method == DecodeMethod::kKang2003)
        write_recording(video, {.name = "four times", .source = {}, .schedule = four_times()}, 1,
                        folder / "clip.stipple");
    else if (named(method).check_schedule == nullptr)
        write_recording(video, "tiled", folder / "clip.stipple");
    else
        write_recording(video, {.name = "full", .source = {}, .schedule = full_schedule(1, 1)}, 1,
                        folder / "clip.stipple");
    video = {};
    return decoding_bytes(folder / "clip.stipple", method);
}

class MemoryTest : public testing::TestWithParam<DecodeMethod> {};

// The limit is that of `check_block` (decoder/reconstruct.cpp), which --max-memory relies on. 5 %
// are the pages of the heap that no array fills.
TEST_P(MemoryTest, ABlockTakesWhatTheTableOfMethodsSays) {
    if (!reset_peak()) GTEST_SKIP() << "/proc/self/clear_refs cannot be written here";
    return_freed_arrays();
    decode_scene(8, {64, 64, 3}, GetParam());  // so that the program code it takes is in memory
    for (const FrameShape shape : {FrameShape{120, 200, 1}, FrameShape{80, 100, 3}}) {
        // Three blocks, the second with a halo on both sides.
        const auto bytes = static_cast<double>(
            decode_scene(2 * kCoreSlots + kRemainderSlots + 1, shape, GetParam()));
        const auto voxels = static_cast<double>((kCoreSlots + 2 * kHaloSlots) * shape.sites());
        const auto frames = static_cast<double>(kCoreSlots * shape.sites() * sizeof(float));
        const double voxel_bytes = (bytes - frames) / voxels;
        RecordProperty("bytes_a_voxel_of_" + std::to_string(shape.planes),
                       std::to_string(voxel_bytes));
        EXPECT_LE(voxel_bytes, 1.05 * static_cast<double>(named(GetParam()).voxel_bytes));
    }
}

INSTANTIATE_TEST_SUITE_P(Methods, MemoryTest,
                         testing::Values(DecodeMethod::kNaive, DecodeMethod::kFast,
                                         DecodeMethod::kBest, DecodeMethod::kLearnedFast,
                                         DecodeMethod::kLearned, DecodeMethod::kReddy2011,
                                         DecodeMethod::kHitomi2011, DecodeMethod::kInterpolated,
                                         DecodeMethod::kBennett2005, DecodeMethod::kZhang2009,
                                         DecodeMethod::kVbm4d, DecodeMethod::kShahar2011,
                                         DecodeMethod::kKang2003),
                         [](const auto& method) { return std::string(named(method.param).name); });

}  // namespace
}  // namespace stipple
