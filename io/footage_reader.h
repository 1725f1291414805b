#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/light.h"
#include "core/message.h"
#include "io/footage_part.h"
#include "io/image.h"
#include "io/raw_format.h"

namespace stipple {

/// Range of the frame rates of footage.
inline constexpr double kMinFramesHz = 0.001;
inline constexpr double kMaxFramesHz = 1e9;

struct FootageOptions {
    std::optional<Transfer> transfer = {};  ///< none: linear, with a warning where it looks wrong
    bool luminance = false;                ///< reduce RGB to Rec. 709 luminance (.2126 .7152 .0722)
    std::optional<double> max_value;       ///< clip light to this value
    std::optional<double> min_value = {};  ///< clip light below this, as negative light, to it
    std::optional<RawFormat> raw = {};     ///< read a file without a header so, whatever its name
    double scale = 1;                      ///< factor on the light, before it is clipped; above 0
    std::optional<double> frames_hz = {};  ///< frame rate, instead of that of the source
    bool negative = false;                 ///< take negative light, as unbiased estimates have it
    bool at_their_times = false;           ///< the caller heeds times of frames: no warning of them
    FootagePart part = {};                 ///< of the frames, once they are light
};

/// Reads footage frame by frame, one frame a time slot, in linear light: 8/16-bit integers are
/// divided by 255 / 65535, floating-point files are taken as they are.
/// Sources: a folder or a printf pattern of images (in numeric order of names), a TIFF file of one
/// or more pages, a video file, a .npy of shape (T,H,W), (T,H,W,3) or (H,W) with dtype u1, u2, f2,
/// f4 or f8, or a file of frames without a header. ReadAhead (capture/recording/read_ahead.h) reads
/// recordings of cameras too, and in the background.
class FootageReader {
  public:
    /// Opens the source and reads its first frame's shape.
    /// \throws InputError if it is missing, unreadable, empty or of a wrong shape, or has no such
    /// part.
    explicit FootageReader(const std::filesystem::path& source, const FootageOptions& options = {});
    ~FootageReader();
    FootageReader(FootageReader&&) noexcept;
    FootageReader& operator=(FootageReader&&) noexcept;

    [[nodiscard]] FrameShape shape() const;
    /// Number of frames in the part, if the source declares it; a video file may not.
    [[nodiscard]] std::optional<int> slots() const;

    /// Frame rate at which a video plays or a camera took the frames, if the source declares it.
    [[nodiscard]] std::optional<double> frames_hz() const;
    /// Whether frames have times of their own, which may be unequally far apart: not with
    /// FootageOptions::frames_hz.
    [[nodiscard]] bool has_times() const;
    /// When the frame read last begins, in frame periods from the first frame of the source on.
    /// Precondition: has_times.
    [[nodiscard]] double frame_time() const;
    /// Exposure time of a frame in microseconds, if the source declares it.
    [[nodiscard]] std::optional<double> exposure_us() const;
    /// Colour filter array of the frames; kNone: they are no mosaic.
    [[nodiscard]] ColourFilter filter() const;
    /// Whether the numbers are no linear light by what the source declares or by its kind.
    [[nodiscard]] bool gamma_coded() const;
    /// What the source declares about its numbers and the camera.
    [[nodiscard]] const SourceInfo& traits() const;
    /// What the source is: "PNG images", "video", ".cine file".
    [[nodiscard]] std::string kind() const;
    /// What the user should know of the source and of its reading that is new since the last call.
    [[nodiscard]] std::vector<Message> take_warnings();

    /// Reads the next frame, order (plane, row, col), into `frame` (shape().sites() floats).
    /// Returns false at the end. \throws InputError naming the file (and for a value the row,
    /// column and plane) if a frame is unreadable, truncated, of another size, or holds NaN,
    /// infinite light, or negative light that the options do not take, or if the source ends before
    /// the part does.
    bool read(std::span<float> frame);
    /// Leaves out the next `frames` frames, unchecked; where the source cannot seek, they are read.
    /// \throws InputError as `read`.
    void skip(int frames);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
