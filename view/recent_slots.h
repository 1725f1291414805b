#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "capture/frame_light.h"
#include "view/packet_source.h"

namespace stipple {

/// The newest slots of a running camera: its frames, and the packets that the emulated sensor makes
/// of them. For several threads.
class RecentSlots {
  public:
    /// Keeps as many slots as 128 MB hold, and 48 at least.
    RecentSlots(const FrameLayout& layout, double black_level_dn, StreamHeader header);

    /// The next slot. Copies both. Without payload it has the frame of the slot before.
    void add(std::span<const std::uint8_t> payload, std::span<const SamplePacket> packets,
             std::int64_t arrival_ns);
    /// From the next slot on the sensor has another schedule, from next.slot on.
    void add(ScheduleSwitch next);
    /// No more slots come.
    void end();

    /// As PacketSource::header. It lacks switches before the slots that are there.
    [[nodiscard]] std::shared_ptr<const StreamHeader> header() const;
    [[nodiscard]] SlotExtent extent() const;
    [[nodiscard]] StreamReport report() const;
    std::shared_ptr<const StreamHeader> visit(
        std::int64_t first, std::int64_t end,
        const std::function<void(const SamplePacket&)>& take) const;
    /// light_code of a frame, order (plane, row, col) of decoded_shape; empty if it is not there.
    /// Each pixel of a mosaic has the colours of its cell of 2 x 2 pixels.
    [[nodiscard]] std::vector<std::uint16_t> codes(std::int64_t slot);
    /// The same of one pixel; nothing if it is not there.
    [[nodiscard]] std::optional<std::uint16_t> code(std::int64_t slot, int plane, int row, int col);
    /// When the frame of a slot came (CLOCK_MONOTONIC); 0 if it is not there.
    [[nodiscard]] std::int64_t arrival_ns(std::int64_t slot) const;

  private:
    struct Slot {
        std::vector<std::uint8_t> payload;
        std::vector<SamplePacket> packets;
        std::int64_t arrival_ns = 0;
    };
    /// The first `bytes` of a frame from byte `first` on; empty if it is not there.
    [[nodiscard]] std::vector<std::uint8_t> payload(std::int64_t slot, std::size_t first,
                                                    std::size_t bytes) const;
    /// Null if it is not there. Precondition: the lock is held.
    [[nodiscard]] const Slot* find(std::int64_t slot) const;

    std::shared_ptr<const StreamHeader> header_;
    FrameLayout layout_;
    int planes_;     ///< of a picture
    int cell_rows_;  ///< that determine the colours of a pixel
    std::mutex light_mutex_;
    FrameLight to_light_;
    FrameLight cells_to_light_;  ///< of cell_rows_ rows
    mutable std::mutex mutex_;
    std::deque<Slot> slots_;
    std::size_t most_ = 0;  ///< slots that are kept
    SlotExtent extent_;
    StreamReport report_;
};

/// Them as the packets of a stream. `recent` must outlive this.
class RecentPackets : public PacketSource {
  public:
    explicit RecentPackets(const RecentSlots& recent) : recent_(recent) {}

    [[nodiscard]] std::shared_ptr<const StreamHeader> header() const override {
        return recent_.header();
    }
    [[nodiscard]] StreamReport report() const override { return recent_.report(); }
    [[nodiscard]] SlotExtent extent() override { return recent_.extent(); }
    std::shared_ptr<const StreamHeader> visit(
        std::int64_t first, std::int64_t end,
        const std::function<void(const SamplePacket&)>& take) override {
        return recent_.visit(first, end, take);
    }

  private:
    const RecentSlots& recent_;
};

}  // namespace stipple
