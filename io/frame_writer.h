#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry.h"
#include "io/frame_coding.h"

namespace stipple {

struct FrameWriterOptions {
    VideoCoding video = {};   ///< of .mp4 / .mkv / .y4m
    ImageCoding images = {};  ///< of a folder and of .tif / .tiff
    bool force = false;       ///< replace an existing output
    bool live = false;        ///< frames of a folder appear there one by one
};

/// Writes a video frame by frame. The name determines the format: a folder of `frame_%04d.exr`,
/// light_%04d.png or light_%04d.tif (linear), `.tif` / `.tiff` (OME-TIFF, linear), `.npy` (float32,
/// (T,H,W) or (T,H,W,3)), `.mp4` / `.mkv` / `.y4m` (io/video_writer.h). The output is written under
/// a hidden name in the same folder, and `finish` renames it. So the final name never holds a
/// partial video; without `finish` nothing remains. To a pipe (is_pipe) .y4m is written at once.
class FrameWriter {
  public:
    /// \throws InputError if the output exists (and not force) or its folder does not, or the
    /// format is unknown. \throws DeviceError if it cannot be created.
    FrameWriter(const std::filesystem::path& output, FrameShape shape,
                FrameWriterOptions options = {});
    ~FrameWriter();
    FrameWriter(const FrameWriter&) = delete;
    FrameWriter& operator=(const FrameWriter&) = delete;

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError (full
    /// disk).
    void write(std::span<const float> frame);
    /// Completes the file with any number of frames. \throws DeviceError.
    void finish();
    /// Of the frames so far, if the output is a video in PQ.
    [[nodiscard]] std::optional<LightLevels> light_levels() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
