#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "study/report/stream_samples.h"
#include "view/packet_source.h"

namespace stipple {

/// A sample stream of which any slot can be looked at. It may still grow. For several threads.
class ViewedStream {
  public:
    /// \throws InputError if the schedule has weights, or as SlotSamples.
    ViewedStream(std::unique_ptr<PacketSource> source, std::string name);

    /// With the switches of the schedule so far: a new object when there are more.
    [[nodiscard]] std::shared_ptr<const StreamHeader> header() const;
    [[nodiscard]] const std::string& name() const { return name_; }
    /// Reads on in a stream without an end.
    [[nodiscard]] SlotExtent extent();
    [[nodiscard]] std::int64_t slots() { return extent().slots; }
    /// What the page needs to know of it (report_data.js: a run).
    [[nodiscard]] nlohmann::ordered_json json();

    /// The samples of a slot, as SlotSamples.
    struct Samples {
        std::vector<std::uint16_t> kinds;
        std::vector<std::uint16_t> dn;
    };
    [[nodiscard]] Samples samples(std::int64_t slot);
    /// By pixel: the slots of light of the exposure that is under way in a slot, by the schedule of
    /// that slot; 0: none.
    [[nodiscard]] std::vector<std::uint16_t> exposure_map(std::int64_t slot) const;
    /// The samples of a pixel that are read in [first, end), each [slot, kind, [DN by plane]]; the
    /// kind as in `json`.
    [[nodiscard]] nlohmann::ordered_json samples_of_pixel(int row, int col, std::int64_t first,
                                                          std::int64_t end);
    struct Packets {
        std::shared_ptr<const StreamHeader> header;  ///< that they belong to
        std::vector<SamplePacket> packets;
    };
    /// The packets of slots [first, end).
    [[nodiscard]] Packets packets(std::int64_t first, std::int64_t end);

  private:
    void use(std::shared_ptr<const StreamHeader> header);
    [[nodiscard]] Samples read_samples(std::int64_t slot);

    mutable std::mutex mutex_;
    std::unique_ptr<PacketSource> source_;
    std::string name_;
    std::shared_ptr<const StreamHeader> header_;  ///< that samples_ uses
    SlotSamples samples_;
    std::int64_t held_slot_ = -1;  ///< whose samples samples_ has; -1: of none that is whole
    SlotExtent extent_;
};

}  // namespace stipple
