#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "stream/stream_reader.h"

namespace stipple {

/// The slots of a source that can be looked at: [first, slots).
struct SlotExtent {
    std::int64_t slots = 0;  ///< so far
    bool complete = false;   ///< no more slots come
    std::int64_t first = 0;  ///< those before are forgotten
};

/// Where the samples of a ViewedStream come from. Its user has a lock.
class PacketSource {
  public:
    virtual ~PacketSource() = default;
    PacketSource(const PacketSource&) = delete;
    PacketSource& operator=(const PacketSource&) = delete;

    /// With the switches of the schedule so far: a new object when there are more.
    [[nodiscard]] virtual std::shared_ptr<const StreamHeader> header() const = 0;
    /// Of the packets so far.
    [[nodiscard]] virtual StreamReport report() const = 0;
    /// Looks for more slots.
    [[nodiscard]] virtual SlotExtent extent() = 0;
    /// Calls `take` with the packets of slots [first, end) that are there, in their order. Returns
    /// the header that they belong to.
    virtual std::shared_ptr<const StreamHeader> visit(
        std::int64_t first, std::int64_t end,
        const std::function<void(const SamplePacket&)>& take) = 0;

  protected:
    PacketSource() = default;
};

/// A file. It may still grow.
class FilePackets : public PacketSource {
  public:
    /// \throws InputError as StreamReader::seek.
    explicit FilePackets(StreamReader reader);

    [[nodiscard]] std::shared_ptr<const StreamHeader> header() const override { return header_; }
    [[nodiscard]] StreamReport report() const override { return reader_.report(); }
    [[nodiscard]] SlotExtent extent() override;
    std::shared_ptr<const StreamHeader> visit(
        std::int64_t first, std::int64_t end,
        const std::function<void(const SamplePacket&)>& take) override;

  private:
    /// Those of the reader, which has only read up to where it is.
    void take_switches();

    StreamReader reader_;
    std::shared_ptr<const StreamHeader> header_;
    std::int64_t next_slot_ = -1;  ///< whose first packet the reader gives next; -1: not known
    SlotExtent extent_;
};

}  // namespace stipple
