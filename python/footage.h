#pragma once

#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "capture/recording/resampled_footage.h"
#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/message.h"
#include "io/footage_reader.h"
#include "io/frame_resampler.h"
#include "readout/provenance.h"
#include "sensor_model/sensor_params.h"

namespace stipple::python {

/// Frames of a NumPy array of shape (slot, row, col) or (slot, row, col, 3) and type uint8, uint16
/// or floating-point, read as those of a .npy file. Frames of float32 that lie plane by plane, each
/// without gaps, are not copied.
class ArrayFrames {
  public:
    /// With the GIL. \throws InputError for another shape or type.
    ArrayFrames(const pybind11::array& array, const FootageOptions& options);

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] std::int64_t slots() const { return array_.shape(0); }
    /// As ReadAhead::next, in linear light. \throws InputError as FootageReader::read.
    std::span<const float> next();
    /// Of digital numbers that were taken for light; empty if there is none.
    [[nodiscard]] const std::string& warning() const { return warning_; }

  private:
    [[nodiscard]] std::span<const float> stored(const std::byte* frame);
    template <typename Sample>
    void take(const std::byte* frame);
    [[nodiscard]] std::span<float> own(std::span<const float> light);

    pybind11::array array_;
    FootageOptions options_;
    FrameShape source_;
    char kind_;        ///< 'u' or 'f', as NumPy has it
    bool contiguous_;  ///< needs no copy
    std::int64_t slot_ = 0;
    std::vector<float> frame_;
    std::vector<float> luminance_;
    std::string warning_;
};

/// How footage is read, and how its frames become slots.
struct Reading {
    FootageOptions options;
    std::optional<Resampling> resampling = {};  ///< none: each frame is a slot
};

/// Light that Python names: an array, or a path to what the program reads.
class Footage {
  public:
    /// With the GIL. \throws InputError as ArrayFrames or ReadAhead, FileError.
    Footage(const pybind11::object& video, Reading reading);
    ~Footage() = default;
    Footage(const Footage&) = delete;
    Footage& operator=(const Footage&) = delete;

    [[nodiscard]] FrameShape shape() const;
    [[nodiscard]] std::optional<std::int64_t> slots() const;
    [[nodiscard]] ColourFilter filter() const;
    /// The next frame, order (plane, row, col), valid until the next call, or empty at the end.
    /// Without the GIL.
    std::span<const float> next();
    /// The frames as slots of this length. \throws InputError as ResampledFootage.
    [[nodiscard]] ResampledFootage resampled(double slot_us);
    /// The origin of the light, for the provenance of a stream. With the GIL: reads files whole.
    [[nodiscard]] FootageOrigin origin() const;
    /// Has Python warn of what does not suit the sensor. Before the first frame, with the GIL.
    void warn_of(const SensorParams& sensor) const;
    /// Has Python warn of what the reader warns of, and of the faults of a recording; with a sensor
    /// also of its frame rate. After the last frame, with the GIL.
    void pass_warnings_on(const SensorParams* sensor = nullptr);
    /// The path, or "video".
    [[nodiscard]] std::string name() const;

  private:
    Reading reading_;
    std::string path_;  ///< empty of an array
    std::vector<Message> warnings_;
    std::optional<ArrayFrames> array_;
    std::unique_ptr<ReadAhead> files_;
};

/// The frames, order (slot, plane, row, col), as an array that owns them: (slot, row, col), or of
/// colour (slot, row, col, plane), plane by plane in memory.
[[nodiscard]] pybind11::array as_array(std::unique_ptr<std::vector<float>> frames,
                                       FrameShape shape);

/// Has Python warn, unless the text is empty. `level` as warnings.warn: 1 blames who has called us,
/// 2 who has called that. With the GIL.
void warn(const Message& text, int level = 2);

}  // namespace stipple::python
