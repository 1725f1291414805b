#pragma once

/// Light: frames of floats, order (plane, row, col), from images, video, .npy and files of
/// high-speed cameras (docs/footage.md), and to images, video and .npy (docs/outputs.md):
///
///     stipple::FootageReader footage("scene.npy");
///     stipple::FrameWriter copy("copy.npy", footage.shape(), {.force = true});
///     std::vector<float> light(footage.shape().sites());
///     while (footage.read(light)) copy.write(light);
///     copy.finish();
///
/// 1.0 is `photons_per_unit` of the sensor. FluxVideo holds a whole video.
#include "core/flux_video.h"
#include "io/footage_reader.h"
#include "io/frame_writer.h"
