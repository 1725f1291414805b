#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/exposure_schedule.h"
#include "core/flux_video.h"
#include "decoder/decode_options.h"
#include "io/npy_file.h"

namespace stipple {

/// Frames that one measurement of the video-SCI benchmark adds up.
inline constexpr int kSciFrames = 8;

/// A clip of the benchmark: `NAME.npy` of (T, H, W) or a folder NAME of images in `folder`, grey
/// (colour becomes luminance), integers as parts of their full scale. Frames beyond the last whole
/// measurement are left out. \throws InputError.
[[nodiscard]] FluxVideo read_sci_clip(const std::filesystem::path& folder, const std::string& name);

/// A stand-in for a clip: an embedded scene, clipped to 0..1, after the power 1/2.2 as in the 8-bit
/// video that the benchmark is made of. \throws InputError if there is no scene of that name.
[[nodiscard]] FluxVideo sci_stand_in(const std::string& scene, int slots, FrameShape shape);

/// Binary masks, half of them ones, from a seed: order (frame, row, col).
[[nodiscard]] NpyVolume random_masks(FrameShape shape, std::uint64_t seed);

/// Grey masks, uniform in 0..1.
[[nodiscard]] NpyVolume grey_masks(FrameShape shape, std::uint64_t seed);

/// Masks as optics blur them: each the mean of 3 x 3 pixels, weights 1, 2, 1 along rows and
/// columns.
[[nodiscard]] NpyVolume blurred_masks(const NpyVolume& masks);

/// The sensor `ideal` with `electrons_per_unit` electrons for light 1.0: no noise but rounding to
/// 16 bits. Decoders take the shot noise of that light into account, though there is none: the more
/// electrons, the more exactly they keep to the samples.
struct SciSensor {
    double electrons_per_unit = 1e6;
    bool noise_free = false;  ///< the stream says that there is no noise
};

/// Records `video` with `masks`, decodes it and returns the mean of the frames' PSNR in dB, of all
/// frames, peak 1.0, decoded light clipped to 0..1. \throws InputError if the masks are no
/// schedule or not of the video's size.
[[nodiscard]] double sci_psnr_db(const FluxVideo& video, const NpyVolume& masks,
                                 const SciSensor& sensor, const DecodeOptions& options);

}  // namespace stipple
