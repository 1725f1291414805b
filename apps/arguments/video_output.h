#pragma once

#include <string>

#include "apps/arguments/command_line.h"
#include "io/frame_writer.h"

namespace stipple {

/// What the frames of an output look like: `--video`, `--codec`, `--fps`, `--cd-per-unit` and
/// `--peak-cd` of a video file, `--images` of a folder, `--samples` and `--full-scale` of images
/// and
/// `--pixel-um` of a TIFF stack.
void add_video_arguments(Command& command, VideoCoding& video, ImageCoding& images);

/// For callbacks. \throws UsageError if one of these options was given that `output` does not need.
void check_video_arguments(const Command& command, const VideoCoding& video,
                           const ImageCoding& images, const std::string& output);

}  // namespace stipple
