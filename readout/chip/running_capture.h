#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "readout/chip/chip_settings.h"
#include "readout/stream_recorder.h"
#include "readout/timing/readout_cost.h"

namespace stipple {

/// The light of the next slot, of the footage's shape; empty at the end of the footage.
using SlotLight = std::function<std::span<const float>()>;
/// Footage from its first frame on.
using OpenLight = std::function<SlotLight()>;

/// What the registers of a chip count.
struct ChipCounters {
    std::uint32_t slots = 0;
    std::uint32_t overruns = 0;
    std::uint32_t dropped = 0;
    std::uint32_t packets = 0;
    std::uint32_t samples = 0;
    std::uint32_t swap_slot = 0;
};

/// What a capture needs.
struct CapturePlan {
    CaptureSettings settings;
    SensorSetup setup;  ///< of the region and the bank's schedule, without timing
    FrameShape light;   ///< of a frame of the footage
};

/// A capture of a chip from START until its last sample has left: slots on the time line of
/// ReadoutCost, each exposed to the next frame of the footage, which begins again at its end.
///
/// Clocks are those of the chip. Whatever happens in a clock is seen from the next one on.
class RunningCapture {
  public:
    /// Writes `file`. \throws InputError, DeviceError as StreamRecorder and the footage.
    RunningCapture(CapturePlan plan, const StreamRecorderOptions& options,
                   const std::filesystem::path& file, OpenLight open_light);

    /// Slot 0 begins in this clock.
    void begin_at(std::int64_t clock) { begin_ = next_begin_ = clock; }
    /// Goes on up to this clock. \throws InputError, DeviceError as the footage and the file.
    void advance(std::int64_t clock);
    /// No slot begins any more.
    void stop() { stops_ = true; }
    /// After a swap that was written in `clock` and whose tables take `fill_clocks` to fill, the
    /// sensor is that of `schedule_from(slot)`, the bank's schedule if it begins with this slot.
    void swap(std::int64_t clock, std::int64_t fill_clocks,
              std::function<SensorSetup(std::int64_t)> schedule_from);

    [[nodiscard]] bool has_ended() const { return ended_; }
    [[nodiscard]] bool is_exposing() const { return counters_.slots > 0 && !is_over_; }
    [[nodiscard]] bool is_swap_pending() const { return swap_.has_value(); }
    /// Since the last swap that was made; then false again.
    [[nodiscard]] bool take_swapped() { return std::exchange(swapped_, false); }
    [[nodiscard]] const ChipCounters& counters() const { return counters_; }
    /// Rows took no clock from their selection to their conversion.
    [[nodiscard]] bool has_no_time() const { return has_no_time_; }
    [[nodiscard]] const SensorSetup& setup() const { return setups_.front(); }
    [[nodiscard]] const CaptureSettings& settings() const { return plan_.settings; }
    /// Why the swap could not be made, which ends the capture; then empty again.
    [[nodiscard]] std::string take_problem() { return std::exchange(problem_, {}); }

  private:
    struct Swap {
        std::int64_t from = 0;  ///< the first clock in which it may be taken
        std::function<SensorSetup(std::int64_t)> schedule_from;
    };
    struct Packed {
        std::int64_t clock = 0;
        ChipCounters counts;
    };
    void take_swap(std::int64_t clock);
    void begin_next();
    void expose();
    void make_swap();
    void end();
    [[nodiscard]] std::span<const float> next_frame();
    [[nodiscard]] std::int64_t scan_end() const;
    [[nodiscard]] bool stops() const;

    CapturePlan plan_;
    std::deque<SensorSetup> setups_;  ///< of the parts of the stream
    ReadoutCost cost_;
    std::unique_ptr<StreamRecorder> recorder_;
    OpenLight open_light_;
    SlotLight light_;
    std::vector<float> region_;

    std::int64_t begin_ = 0;       ///< of slot 0
    std::int64_t next_begin_ = 0;  ///< of the next slot
    SlotCost slot_;                ///< the last one
    bool stops_ = false;
    bool is_over_ = false;
    bool ended_ = false;
    std::int64_t idle_ = 0;  ///< the last sample has left
    std::optional<Swap> swap_;
    bool is_taken_ = false;  ///< the next slot is the first one after the swap
    bool swapped_ = false;
    bool has_no_time_ = false;
    std::string problem_;
    ChipCounters counters_;
    std::deque<Packed> packed_;
};

}  // namespace stipple
