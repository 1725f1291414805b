#pragma once

#include <functional>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "capture/recording/recording_footage.h"
#include "core/message.h"
#include "io/footage_reader.h"

namespace stipple {

/// Footage, or a recording of a camera, whose next frame is read in the background while one is
/// worked on.
class ReadAhead {
  public:
    /// Passes the warnings of the reader to `warn`. \throws InputError as FootageReader,
    /// RecordingFootage and check_recording_options, and as check_memory if frames are too large.
    ReadAhead(const std::filesystem::path& source, const FootageOptions& options,
              std::function<void(const Message&)> warn);
    ~ReadAhead() = default;
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] std::optional<int> slots() const;
    /// As FootageReader::frames_hz; the rate of a recording is known at its end.
    [[nodiscard]] std::optional<double> frames_hz() const;
    /// As FootageReader::has_times; a recording has none.
    [[nodiscard]] bool has_times() const { return has_times_; }
    /// As FootageReader::frame_time, of the frame that `next` gave last.
    [[nodiscard]] double frame_time() const { return time_; }
    /// As FootageReader::exposure_us; unknown for a recording.
    [[nodiscard]] std::optional<double> exposure_us() const;
    /// As FootageReader::traits; empty of a recording.
    [[nodiscard]] SourceInfo traits() const;
    /// Colour filter array of the frames; kNone: they are no mosaic.
    [[nodiscard]] ColourFilter filter() const;
    /// As FootageReader::gamma_coded; a recording is not.
    [[nodiscard]] bool gamma_coded() const;

    /// The next frame, valid until the next call, or an empty span at the end.
    /// \throws InputError as FootageReader::read and RecordingFootage::read.
    std::span<const float> next();
    /// Leaves out the next `frames` frames. A recording and a video are read, the others are not.
    /// \throws InputError as `next`.
    void skip(int frames);

    /// Whether `next` was empty.
    [[nodiscard]] bool ended() const { return !reading_.valid(); }

    /// The recording; null of other footage. Not while a frame is read: after `next` was empty.
    [[nodiscard]] const RecordingFootage* recording() const;

  private:
    void pass_warnings_on();
    void start_reading();

    std::function<void(const Message&)> warn_;
    std::variant<FootageReader, RecordingFootage> reader_;
    bool has_times_ = false;
    double time_ = 0;
    std::vector<float> current_;
    std::vector<float> coming_;
    std::future<bool> reading_;  ///< last: waits for the reader before its memory goes
};

}  // namespace stipple
