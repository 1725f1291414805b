#include "decoder/reconstruct.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/gap_limit.h"
#include "core/index.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "decoder/block_partition.h"
#include "decoder/decode_cost.h"
#include "decoder/decode_method.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

/// The packets that the blocks being decoded need, read as late as possible.
class PacketBuffer {
  public:
    /// Packets of slots below `first_slot` are left out, unread where the stream has an index.
    PacketBuffer(StreamReader& reader, const DecodeOptions& options, std::int64_t first_slot)
        : reader_(reader), options_(options), counts_(reader.header()), first_slot_(first_slot) {
        if (first_slot > 0) slots_ = reader.seek(first_slot);
    }

    /// Reads on until every packet of slots below `slot` is here, or the stream ends.
    void read_up_to(std::int64_t slot) {
        while (!ended_ && slots_ <= slot) {
            SamplePacket packet;
            ended_ = !reader_.next(packet);
            if (ended_) break;
            if (packet.slot >= slots_) {
                ++present_;
                reach(packet.slot);
                ++slots_;
            }
            if (packet.slot < first_slot_) continue;
            counts_.add(packet);
            packets_.push_back(std::move(packet));
        }
        if (ended_) reach(reader_.slots().value_or(0));
    }
    void drop_below(std::int64_t slot) {
        std::erase_if(packets_, [&](const SamplePacket& packet) { return packet.slot < slot; });
    }
    /// Number of slots of the stream, as far as it has been read.
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    [[nodiscard]] std::span<const SamplePacket> packets() const { return packets_; }
    /// Of all packets so far.
    [[nodiscard]] const SaturatedSamples& counts() const { return counts_; }

  private:
    /// Takes the slots below `slot` that have not come for missing. \throws InputError if they are
    /// out of proportion.
    void reach(std::int64_t slot) {
        if (slot <= slots_) return;
        missing_ += slot - slots_;
        const std::int64_t max_missing =
            max_missing_slots(present_, decoded_shape(reader_.header()));
        if (!options_.fill_gaps && missing_ > max_missing)
            throw InputError(reader_.name(),
                             fmt::format("slots {} to {} are missing, which makes {} of {}; to "
                                         "decode them too, give ",
                                         slots_, slot - 1, missing_, missing_ + present_) +
                                 Parameter{"fill_gaps", "true"});
        slots_ = slot;
    }

    StreamReader& reader_;
    const DecodeOptions& options_;
    SaturatedSamples counts_;
    std::int64_t first_slot_;
    bool ended_ = false;
    std::int64_t slots_ = 0;
    std::int64_t present_ = 0;  ///< slots of these with a packet
    std::int64_t missing_ = 0;
    std::vector<SamplePacket> packets_;
};

/// The same of all sensors of a rig; slots are those of the first one.
class RigBuffer {
  public:
    RigBuffer(std::span<const RigStream> rig, const DecodeOptions& options, std::int64_t first_slot)
        : rig_(rig) {
        for (const RigStream& stream : rig)
            buffers_.emplace_back(stream.reader, options, first_slot - stream.view.phase_slots);
    }

    void read_up_to(std::int64_t slot) {
        for_each(
            [&](PacketBuffer& buffer, std::int64_t phase) { buffer.read_up_to(slot - phase); });
    }
    void drop_below(std::int64_t slot) {
        for_each(
            [&](PacketBuffer& buffer, std::int64_t phase) { buffer.drop_below(slot - phase); });
    }
    [[nodiscard]] const PacketBuffer& first() const { return buffers_.front(); }
    /// Valid until the next call.
    [[nodiscard]] std::vector<SensorSamples> samples() const {
        std::vector<SensorSamples> samples;
        for (std::size_t i = 0; i < rig_.size(); ++i)
            samples.push_back({rig_[i].reader.header(), buffers_[i].packets(), rig_[i].view});
        return samples;
    }
    void count(DecodeReport& report) const {
        for (const PacketBuffer& buffer : buffers_) {
            report.samples += buffer.counts().samples();
            report.saturated_samples += buffer.counts().saturated();
            report.zero_samples += buffer.counts().zeros();
        }
    }

  private:
    template <typename Body>
    void for_each(const Body& body) {
        for (std::size_t i = 0; i < rig_.size(); ++i) body(buffers_[i], rig_[i].view.phase_slots);
    }

    std::span<const RigStream> rig_;
    std::deque<PacketBuffer> buffers_;
};

using Block = std::optional<FluxVideo>;  ///< nothing if stopped

/// Where a block's core goes in the frames of its slots.
struct Placement {
    Tile tile;
    HaloRange slots;
};

/// Copies the core of a decoded block; light is not negative.
void copy_core(const FluxVideo& block, const Placement& at, FluxVideo& video) {
    const auto [rows, cols] = at.tile;
    const auto width = index(cols.core_end - cols.core_begin);
    for (std::int64_t slot = at.slots.core_begin; slot < at.slots.core_end; ++slot)
        for (int plane = 0; plane < video.shape().planes; ++plane)
            for (std::int64_t row = rows.core_begin; row < rows.core_end; ++row) {
                const auto from = block.plane(static_cast<int>(slot - at.slots.begin), plane)
                                      .row(static_cast<int>(row - rows.begin))
                                      .subspan(index(cols.core_begin - cols.begin), width);
                const auto to = video.plane(static_cast<int>(slot - at.slots.core_begin), plane)
                                    .row(static_cast<int>(row))
                                    .subspan(index(cols.core_begin), width);
                std::transform(from.begin(), from.end(), to.begin(),
                               [](float light) { return std::max(light, 0.0F); });
            }
}

/// Puts together what the tiles of a block of slots tell of their stages.
class StageRelay {
  public:
    StageRelay(const StageSink& sink, FrameShape shape, const HaloRange& slots)
        : sink_(sink), shape_(shape), slots_(slots) {}

    /// The observer of one tile, while this object lives.
    StageObserver observer(const Tile& tile, std::size_t number) {
        StageObserver observer;
        if (sink_.frame)
            observer.finished = [this, tile](std::string_view stage, const FluxVideo& estimate) {
                copy_core(estimate, {tile, slots_}, video_of(stage));
            };
        if (sink_.step)
            observer.iterated = [this, number](std::string_view stage, int iteration,
                                               double objective) {
                sink_.step(
                    {slots_.core_begin, static_cast<int>(number), stage, iteration, objective});
            };
        return observer;
    }
    void deliver() const {
        for (const auto& [stage, video] : videos_)
            for (int slot = 0; slot < video.slots(); ++slot)
                sink_.frame(stage, slots_.core_begin + slot, video.frame(slot));
    }

  private:
    FluxVideo& video_of(std::string_view stage) {
        for (auto& [name, video] : videos_)
            if (name == stage) return video;
        const auto slots = static_cast<int>(slots_.core_end - slots_.core_begin);
        return videos_.emplace_back(std::string(stage), FluxVideo(slots, shape_)).second;
    }

    const StageSink& sink_;
    FrameShape shape_;
    HaloRange slots_;
    std::vector<std::pair<std::string, FluxVideo>> videos_;
};

VideoWindow window_of(const Tile& tile, const HaloRange& slots, int planes) {
    return {.first_slot = slots.begin,
            .slots = static_cast<int>(slots.end - slots.begin),
            .first_row = static_cast<int>(tile.rows.begin),
            .first_col = static_cast<int>(tile.cols.begin),
            .shape = {.rows = static_cast<int>(tile.rows.end - tile.rows.begin),
                      .cols = static_cast<int>(tile.cols.end - tile.cols.begin),
                      .planes = planes}};
}

bool has_samples(const SensorSamples& sensor, const HaloRange& slots) {
    return std::ranges::any_of(sensor.packets, [&](const SamplePacket& packet) {
        return packet.slot + sensor.view.phase_slots < slots.end;
    });
}

/// Decodes the cores of all tiles of a block of slots. No packet is older than the block.
Block decode_slots(std::span<const SensorSamples> sensors, const DecodeOptions& options,
                   const HaloRange& slots, const ProgressCallback& progress) {
    const FrameShape shape = decoded_shape(sensors.front().header);
    FluxVideo video(static_cast<int>(slots.core_end - slots.core_begin), shape);
    const auto in_block = [&](const SensorSamples& sensor) { return has_samples(sensor, slots); };
    if (std::ranges::none_of(sensors, in_block)) return video;  // a long gap: nothing is known
    const Calibration calibration = joint_calibration(sensors, slots.begin);
    const std::vector<Tile> tiles = frame_tiles(shape, named(options.method).max_tile_sites);
    StageRelay stages(options.stages, shape, slots);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
        const auto tile_progress = [&](double fraction) {
            return progress((static_cast<double>(i) + fraction) /
                            static_cast<double>(tiles.size()));
        };
        const VideoWindow window = window_of(tiles[i], slots, shape.planes);
        const Block block = decode_block(collect_joint(sensors, window), calibration, options,
                                         tile_progress, stages.observer(tiles[i], i));
        if (!block || !tile_progress(1)) return {};
        copy_core(*block, {tiles[i], slots}, video);
    }
    stages.deliver();
    return video;
}

/// Slots with few samples take few bytes, but are frames. \throws InputError if the first `slots`
/// slots are more than 2^25 values of light (128 MB), and more than 128 for a sample or, of a file
/// of less than 1 MB, more than 2^26 (256 MB).
void check_proportion(const StreamReader& reader, const DecodeOptions& options, std::int64_t slots,
                      std::uint64_t samples) {
    const StreamHeader& header = reader.header();
    const auto values = [&](FrameShape shape) {
        return static_cast<double>(slots) * static_cast<double>(shape.sites());
    };
    const double light = values(decoded_shape(header));
    const bool sampled = values(header.shape) <= 128 * static_cast<double>(samples) &&
                         (light <= 0x1p26 || reader.input_bytes() >= kSmallInput);
    if (options.fill_gaps || light <= 0x1p25 || sampled) return;
    throw InputError(reader.name(),
                     fmt::format("slots up to {} hold {} samples only, for {:.0f} MB of frames; "
                                 "to decode them nevertheless, give ",
                                 slots - 1, samples, light * sizeof(float) * 1e-6) +
                         Parameter{"fill_gaps", "true"});
}

/// \throws InputError as check_memory for a block of slots. A small file is one for it that has
/// less than a byte for 32 voxels, as no common schedule and bit depth make it.
void check_block(std::span<const RigStream> rig, const DecodeOptions& options,
                 const HaloRange& slots) {
    constexpr std::uint64_t kVoxelsPerByte = 32;
    const StreamReader& reader = rig.front().reader;
    const FrameShape shape = decoded_shape(reader.header());
    const std::int64_t block_slots = slots.end - slots.begin;
    const BlockCost cost =
        block_cost(rig, options.method, block_slots, slots.core_end - slots.core_begin);
    const bool small = cost.voxels / kVoxelsPerByte > reader.input_bytes();
    check_memory(cost.bytes, reader.name(),
                 fmt::format("{} slots of {} x {} by the method {}", block_slots, shape.cols,
                             shape.rows, named(options.method).name),
                 small ? reader.input_bytes() : kEndlessInput);
}

/// \throws InputError if a method that asks for a certain schedule meets a switch.
void check_switches(const StreamReader& reader, const NamedDecodeMethod& method) {
    if (method.check_schedule == nullptr || reader.header().switches.empty()) return;
    throw InputError(reader.name(),
                     fmt::format("its schedule changes at slot {}, but method {} decodes one",
                                 reader.header().switches.front().slot, method.name));
}

/// \throws InputError if a sensor cannot be decoded with the first one.
void check_like_first(const RigStream& stream, const StreamReader& first) {
    const StreamHeader& header = stream.reader.header();
    const FrameShape shape = decoded_shape(header), wanted = decoded_shape(first.header());
    const auto fail = [&](const std::string& problem) {
        throw InputError(stream.reader.name(), problem);
    };
    if (header.slot_us != first.header().slot_us)
        fail(fmt::format("has slots of {} us, but {} has {} us; all sensors of a rig have the same",
                         header.slot_us, first.name(), first.header().slot_us));
    if (shape != wanted)
        fail(
            fmt::format("decodes to {} x {} x {}, but {} to {} x {} x {} (width x height x "
                        "planes); all sensors of a rig have the same",
                        shape.cols, shape.rows, shape.planes, first.name(), wanted.cols,
                        wanted.rows, wanted.planes));
    const Homography& map = stream.view.from_reference;
    if (map.is_singular() || !map.is_finite_on(shape) || overlap_pixels(map, shape) == 0)
        fail("sees no pixel of the first sensor; its offset or homography leads out of the frame");
    if (const auto slots = first.slots(); slots && stream.view.phase_slots >= *slots)
        fail(fmt::format("begins at slot {}, but the first sensor has {} slots",
                         stream.view.phase_slots, *slots));
}

std::string methods_that_join_sensors() {
    std::vector<std::string_view> names;
    for (const NamedDecodeMethod& method : decode_methods())
        if (method.joins_sensors) names.push_back(method.name);
    return joined(names);
}

/// \throws InputError as `decode_rig`.
void check_rig(std::span<const RigStream> rig, const DecodeOptions& options) {
    const RigStream& first = rig.front();
    if (!first.view.from_reference.is_identity() || first.view.phase_slots != 0)
        throw InputError(first.reader.name(), "is the first sensor of a rig, so it is not moved");
    const NamedDecodeMethod& method = named(options.method);
    if (rig.size() == 1) {
        if (method.check_schedule != nullptr)
            method.check_schedule(first.reader.header().schedule, first.reader.name(), method.name);
        return;
    }
    if (!method.joins_sensors)
        throw InputError(
            first.reader.name(),
            fmt::format("is one of {} sensors, but method {} decodes one; {} join them", rig.size(),
                        method.name, methods_that_join_sensors()));
    for (const RigStream& stream : rig.subspan(1)) check_like_first(stream, first.reader);
}

}  // namespace

std::optional<FluxVideo> decode_block(Measurements measurements, const Calibration& calibration,
                                      const DecodeOptions& options,
                                      const ProgressCallback& progress,
                                      const StageObserver& observer) {
    return named(options.method).decode({measurements, calibration, options, progress, observer});
}

DecodeReport decode_rig(std::span<const RigStream> rig, const DecodeOptions& options,
                        const FrameSink& sink, const ProgressCallback& progress) {
    const auto begin = std::chrono::steady_clock::now();
    check_rig(rig, options);
    StreamReader& reader = rig.front().reader;
    if (rig.size() == 1) reader.follow_switches();
    const std::int64_t max_halo = max_halo_slots(rig);
    const std::int64_t first_packet = std::max<std::int64_t>(options.first_slot - max_halo, 0);
    RigBuffer buffer(rig, options, first_packet);
    DecodeReport report;
    std::int64_t next = options.first_slot;
    for (bool more = true; more;) {
        buffer.read_up_to(next + kCoreSlots + std::max(kRemainderSlots, max_halo));
        check_switches(reader, named(options.method));
        const std::int64_t halo = halo_at(rig, next);
        const HaloRange slots = slot_range(next, buffer.first().slots(), halo);
        if (slots.core_end <= slots.core_begin) break;
        check_proportion(reader, options, slots.core_end - first_packet,
                         buffer.first().counts().samples());
        check_block(rig, options, slots);
        buffer.drop_below(slots.begin);
        const auto block_progress = [&](double fraction) {
            return progress(static_cast<double>(slots.core_begin) +
                            fraction * static_cast<double>(slots.core_end - slots.core_begin));
        };
        const Block video = decode_slots(buffer.samples(), options, slots, block_progress);
        if (!video) break;
        for (int slot = 0; slot < video->slots() && more; ++slot)
            more = sink(next++, video->frame(slot));
    }
    report.slots = next - options.first_slot;
    report.voxels =
        static_cast<std::uint64_t>(report.slots) * decoded_shape(reader.header()).sites();
    buffer.count(report);
    report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return report;
}

DecodeReport decode(StreamReader& reader, const DecodeOptions& options, const FrameSink& sink,
                    const ProgressCallback& progress) {
    const RigStream alone{reader};
    return decode_rig({&alone, 1}, options, sink, progress);
}

DecodeReport decode(StreamReader& reader, DecodeMethod method, const FrameSink& sink,
                    const ProgressCallback& progress) {
    return decode(reader, DecodeOptions{.method = method}, sink, progress);
}

}  // namespace stipple
