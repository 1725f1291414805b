#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "io/frame_writer.h"
#include "io/pending_output.h"

namespace stipple {

/// The error of a video: |result - reference| of each frame in linear light as a folder of EXR
/// files or a .npy, or the root of its mean square over the frames as one .png, tone-mapped.
class DifferenceOutput {
  public:
    /// Light is first clipped to `max_value`, if given. \throws InputError, DeviceError as
    /// FrameWriter and PendingOutput.
    DifferenceOutput(const std::filesystem::path& file, FrameShape shape, bool force,
                     std::optional<double> max_value);

    /// One frame of each, shape.sites() values.
    void add(std::span<const float> result, std::span<const float> reference);
    /// Completes the output. Precondition: a frame was added. \throws DeviceError.
    void finish();

  private:
    FrameShape shape_;
    float max_value_;
    std::optional<PendingOutput> image_;  ///< of a .png
    std::unique_ptr<FrameWriter> video_;  ///< of all others
    std::vector<float> difference_;
    std::vector<double> squares_;  ///< sums over the frames, of a .png
    std::int64_t frames_ = 0;
};

}  // namespace stipple
