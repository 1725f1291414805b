#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "capture/frame_light.h"
#include "capture/frame_sequence.h"
#include "capture/recording/recording_reader.h"
#include "core/message.h"
#include "io/footage_reader.h"

namespace stipple {

/// The numbers of a recording are linear light and have their format, so options of footage would
/// do nothing. \throws InputError if one differs from its default.
void check_recording_options(const std::filesystem::path& recording, const FootageOptions& options);

struct RecordingFootageOptions {
    /// True: the previous frame replaces missing frames, so that each slot keeps its time.
    /// False: missing frames are left out.
    bool hold_missing = true;
    /// True: incomplete frames count as missing. False: they are used, with black holes.
    bool drop_incomplete = true;
    /// Hold for any number of missing frames, beyond max_missing_slots.
    bool fill_gaps = false;
    double black_level_dn = 0;
};

/// A gap: consecutive missing or incomplete frames.
struct RecordingGap {
    std::int64_t slot = 0;  ///< of the footage: the first held slot, or the slot after the gap
    std::uint64_t frames = 0;
};

/// A recording as footage, one frame per slot, with the interface of FootageReader: linear
/// light, 1.0 at full scale.
class RecordingFootage {
  public:
    /// \throws InputError as RecordingReader, if there is no frame, or for a black level out of the
    /// range of its format.
    explicit RecordingFootage(const std::filesystem::path& file,
                              RecordingFootageOptions options = {});

    [[nodiscard]] FrameShape shape() const { return light_.shape(); }
    /// Colour filter array of the mosaic.
    [[nodiscard]] ColourFilter filter() const { return light_.filter(); }
    /// Reads the next frame, order (plane, row, col), into `frame` (shape().sites() floats).
    /// Returns false at the end. \throws InputError for a frame of another layout, and if more than
    /// max_missing_slots would have to be held.
    bool read(std::span<float> frame);

    /// Slots that repeat the previous frame.
    [[nodiscard]] std::uint64_t held_slots() const { return held_; }
    /// Missing or incomplete frames so far; frames lost by damage of the file are missing too.
    [[nodiscard]] std::uint64_t missing_frames() const { return missing_; }
    /// Frame rate of the camera, from the frames so far.
    [[nodiscard]] const FrameRate& rate() const { return rate_; }
    static constexpr std::size_t kMaxListedGaps = kMaxListedFaults;
    /// The first kMaxListedGaps gaps so far.
    [[nodiscard]] const std::vector<RecordingGap>& gaps() const { return gaps_; }
    /// Whether all frames were read, so that the reader's report is complete.
    [[nodiscard]] bool at_end() const { return !has_coming_; }
    [[nodiscard]] const RecordingReader& recording() const { return reader_; }

  private:
    /// Sets `coming_` to the next used frame, and `to_hold_`. Returns false at the end.
    bool advance();
    void check_proportion(const FrameRecord& record);
    void note(std::uint64_t frames);

    std::filesystem::path file_;
    RecordingReader reader_;
    RecordingFootageOptions options_;
    GapFiller filler_;
    CapturedFrame coming_;
    std::int64_t slots_ = 0;  ///< slots read
    std::vector<RecordingGap> gaps_;
    std::int64_t usable_ = 0;    ///< frames so far
    std::int64_t holding_ = 0;   ///< held slots, with those before `coming_`
    std::uint64_t to_hold_ = 0;  ///< slots before `coming_` still to be held
    std::uint64_t held_ = 0;
    std::uint64_t missing_ = 0;
    FrameRate rate_;
    bool has_coming_;  ///< initialised by `advance`, which uses the members above
    FrameLight light_;
    std::vector<float> last_;  ///< light of the previous frame; empty before the first
};

}  // namespace stipple
