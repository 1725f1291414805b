#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "capture/frame_light.h"
#include "capture/frame_rate.h"
#include "capture/recording/recording_reader.h"

namespace stipple {

struct RecordingFootageOptions {
    /// Where frames are missing the frame before stands in, so that each slot keeps its time; else
    /// they are left out.
    bool hold_missing = true;
    /// Incomplete frames count as missing; else they are used, with black holes.
    bool drop_incomplete = true;
    /// Holds for as many frames as are missing, even if these are out of proportion.
    bool fill_gaps = false;
    double black_level_dn = 0;
};

/// A place where frames are missing or incomplete.
struct RecordingGap {
    std::int64_t slot = 0;  ///< of the footage: the first that is held, or that comes after them
    std::uint64_t frames = 0;
};

/// A recording as footage, one frame a time slot, read as FootageReader reads: linear light, 1.0 at
/// full scale.
class RecordingFootage {
  public:
    /// \throws InputError as RecordingReader, if there is no frame, or for a black level that its
    /// format does not have.
    explicit RecordingFootage(const std::filesystem::path& file,
                              RecordingFootageOptions options = {});

    [[nodiscard]] FrameShape shape() const { return light_.shape(); }
    /// Whose mosaic the frames are.
    [[nodiscard]] ColourFilter filter() const { return light_.filter(); }
    /// Reads the next frame, order (plane, row, col), into `frame` (shape().sites() floats).
    /// Returns false at the end. \throws InputError for a frame of another layout, and where more
    /// frames are to be held than max_missing_slots.
    bool read(std::span<float> frame);

    /// Slots that repeat the frame before.
    [[nodiscard]] std::uint64_t held_slots() const { return held_; }
    /// Frames that are missing, also by damage of the file, or incomplete, so far.
    [[nodiscard]] std::uint64_t missing_frames() const { return missing_; }
    /// The camera's, by the frames so far.
    [[nodiscard]] const FrameRate& rate() const { return rate_; }
    static constexpr std::size_t kMaxListedGaps = 1000;
    /// The first of the places where they are, so far.
    [[nodiscard]] const std::vector<RecordingGap>& gaps() const { return gaps_; }
    /// Whether all frames were read, so that the reader's report is complete.
    [[nodiscard]] bool at_end() const { return !has_coming_; }
    [[nodiscard]] const RecordingReader& recording() const { return reader_; }

  private:
    /// False at the end; else `coming_` is the next frame that is used and `to_hold_` is set.
    bool advance();
    void check_proportion(const FrameRecord& record);
    void note(std::uint64_t frames);

    std::filesystem::path file_;
    RecordingReader reader_;
    RecordingFootageOptions options_;
    std::optional<std::uint64_t> last_id_;  ///< of the frame read last, usable or not
    CapturedFrame coming_;
    std::int64_t slots_ = 0;  ///< that were read
    std::vector<RecordingGap> gaps_;
    std::int64_t usable_ = 0;    ///< frames so far
    std::int64_t holding_ = 0;   ///< slots that were or will be held
    std::uint64_t to_hold_ = 0;  ///< slots before `coming_` that are still missing
    std::uint64_t held_ = 0;
    std::uint64_t missing_ = 0;
    FrameRate rate_;
    bool has_coming_;  ///< initialised by `advance`, which uses what stands before
    FrameLight light_;
    std::vector<float> last_;  ///< light of the frame before; empty before the first
};

}  // namespace stipple
