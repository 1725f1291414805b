#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "session/stream_calibration.h"
#include "stream/stream_reader.h"
#include "study/report/stream_samples.h"

namespace stipple {

/// A sample stream of which any slot can be looked at. It may still grow. For several threads.
class ViewedStream {
  public:
    /// \throws InputError as StreamReader and calibrate; if the schedule has weights, or as
    /// SlotSamples.
    ViewedStream(const std::filesystem::path& file, const CalibrationChoice& calibration);

    [[nodiscard]] const StreamHeader& header() const { return reader_.header(); }
    /// The stem of its file.
    [[nodiscard]] const std::string& name() const { return name_; }
    /// A warning that it has no calibration, or empty.
    [[nodiscard]] const Message& warning() const { return warning_; }
    struct Extent {
        std::int64_t slots = 0;  ///< so far
        bool complete = false;   ///< no more slots come
    };
    /// Reads on in a stream without an end.
    [[nodiscard]] Extent extent();
    [[nodiscard]] std::int64_t slots() { return extent().slots; }
    /// What the page needs to know of it (report_data.js: a run).
    [[nodiscard]] nlohmann::ordered_json json();

    /// The samples of a slot, as SlotSamples.
    struct Samples {
        std::vector<std::uint16_t> kinds;
        std::vector<std::uint16_t> dn;
    };
    [[nodiscard]] Samples samples(std::int64_t slot);
    /// By pixel: the slots of light of the exposure that is under way in a slot; 0: none.
    [[nodiscard]] std::vector<std::uint16_t> exposure_map(std::int64_t slot) const;
    /// The samples of a pixel that are read in [first, end), each [slot, kind, [DN by plane]]; the
    /// kind as in `json`.
    [[nodiscard]] nlohmann::ordered_json samples_of_pixel(int row, int col, std::int64_t first,
                                                          std::int64_t end);
    /// The packets of slots [first, end).
    [[nodiscard]] std::vector<SamplePacket> packets(std::int64_t first, std::int64_t end);

  private:
    /// Reads to the present end. Precondition: the lock is held.
    void read_on();
    [[nodiscard]] Samples read_samples(std::int64_t slot);
    /// Calls `take` with the packets of [first, end).
    template <typename Take>
    void visit_packets(std::int64_t first, std::int64_t end, const Take& take);

    std::mutex mutex_;
    StreamReader reader_;
    std::string name_;
    Message warning_;
    SlotSamples samples_;
    std::int64_t next_slot_ = -1;  ///< whose first packet the reader gives next; -1: not known
    std::int64_t held_slot_ = -1;  ///< whose samples samples_ has; -1: of none that is whole
    Extent extent_;
};

}  // namespace stipple
