#pragma once

#include <future>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "capture/recording/recording_footage.h"
#include "io/footage_reader.h"

namespace stipple {

/// Footage, or a recording of a camera, whose next frame is read in the background while one is
/// worked on. What its reader warns of goes to standard error.
class ReadAhead {
  public:
    /// \throws InputError as FootageReader and RecordingFootage; if a recording shall have another
    /// transfer than linear or be reduced to luminance; as check_memory if frames are too large.
    ReadAhead(const std::filesystem::path& source, const FootageOptions& options);
    ~ReadAhead() = default;
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] std::optional<int> slots() const;
    /// Frames a second at which a film plays; of a video file only.
    [[nodiscard]] std::optional<double> film_hz() const;
    /// Whose mosaic the frames are; of a recording only.
    [[nodiscard]] ColourFilter filter() const;
    /// As FootageReader::gamma_coded; a recording is not.
    [[nodiscard]] bool gamma_coded() const;

    /// The next frame, valid until the next call, or an empty span at the end.
    /// \throws InputError as FootageReader::read and RecordingFootage::read.
    std::span<const float> next();

    /// The recording; null of other footage. Not while a frame is read: after `next` was empty.
    [[nodiscard]] const RecordingFootage* recording() const;

  private:
    void say_warnings();
    void start_reading();

    std::variant<FootageReader, RecordingFootage> reader_;
    std::vector<float> current_;
    std::vector<float> coming_;
    std::future<bool> reading_;  ///< last: waits for the reader before its memory goes
};

}  // namespace stipple
