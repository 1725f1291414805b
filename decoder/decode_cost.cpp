#include "decoder/decode_cost.h"

#include <algorithm>

#include "core/parallel.h"
#include "decoder/block_partition.h"
#include "decoder/measurements.h"

namespace stipple {
namespace {

std::uint64_t largest_tile_sites(FrameShape shape, DecodeMethod method) {
    std::int64_t pixels = 0;
    for (const auto& [rows, cols] : frame_tiles(shape, named(method).max_tile_sites))
        pixels = std::max(pixels, (rows.end - rows.begin) * (cols.end - cols.begin));
    return static_cast<std::uint64_t>(pixels * shape.planes);
}

int longest_span_slots(std::span<const RigStream> rig) {
    int longest = 0;
    for (const RigStream& stream : rig)
        longest = std::max(longest, stream.reader.header().schedule.longest_span_slots());
    return longest;
}

int longest_span_at(const StreamHeader& header, std::int64_t core_begin) {
    int longest = header.schedule.longest_span_slots();
    for (const ScheduleSwitch& part : header.switches) {
        if (part.slot > core_begin + kCoreSlots + kMaxHaloSlots) break;
        if (part.slot <= core_begin - kMaxExposureSlots) longest = 0;  // of schedules before
        longest = std::max(longest, part.longest_span_slots);
    }
    return longest;
}

}  // namespace

std::int64_t halo_at(const StreamHeader& header, std::int64_t core_begin) {
    return halo_slots(longest_span_at(header, core_begin));
}

std::int64_t max_halo_slots(std::span<const RigStream> rig) {
    const bool may_switch = rig.front().reader.header().may_switch;
    return may_switch ? kMaxHaloSlots : halo_slots(longest_span_slots(rig));
}

std::int64_t halo_at(std::span<const RigStream> rig, std::int64_t core_begin) {
    int longest = 0;
    for (const RigStream& stream : rig)
        longest = std::max(longest, longest_span_at(stream.reader.header(), core_begin));
    return halo_slots(longest);
}

std::int64_t computed_slots(std::int64_t frames, std::int64_t slots) {
    std::int64_t end = 0;
    while (end < frames) end = slot_range(end, slots).core_end;
    return end;
}

BlockCost block_cost(std::span<const RigStream> rig, DecodeMethod method, std::int64_t block_slots,
                     std::int64_t core_slots) {
    constexpr std::uint64_t kSensorBytes = 46;  // a voxel of a further sensor, at its most
    const FrameShape shape = decoded_shape(rig.front().reader.header());
    std::uint64_t voxel_bytes = named(method).voxel_bytes + (rig.size() - 1) * kSensorBytes;
    for (const RigStream& stream : rig)
        if (stream.reader.header().schedule.weighted()) voxel_bytes += sizeof(float);
    const std::uint64_t voxels =
        static_cast<std::uint64_t>(block_slots) * largest_tile_sites(shape, method);
    return {voxels, static_cast<std::uint64_t>(core_slots) * shape.sites() * sizeof(float) +
                        voxels * voxel_bytes};
}

DecodeCost expected_cost(std::span<const RigStream> rig, DecodeMethod method, std::int64_t slots) {
    const FrameShape shape = decoded_shape(rig.front().reader.header());
    const double voxels = static_cast<double>(slots) * static_cast<double>(shape.sites());
    const std::int64_t core = std::min(slots, kCoreSlots + kRemainderSlots);
    return {.seconds = 1e-6 * named(method).voxel_us * voxels / thread_count(),
            .bytes = block_cost(rig, method, std::min(slots, core + kHaloSlots), core).bytes};
}

}  // namespace stipple
