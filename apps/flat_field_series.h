#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "metrics/emva1288/camera_figures.h"
#include "metrics/emva1288/series.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Images of a series: a dark pair, 50 bright pairs in equal steps up to 1.15 of saturation, 100 at
/// half of saturation, 100 dark.
inline constexpr int kSeriesImages = 2 + 2 * 50 + 100 + 100;

/// Name of the descriptor in the folder of a series.
inline constexpr const char* kDescriptorName = "emva1288_data.txt";

/// Whether an image of a series may have this name: image_0001.png ...
[[nodiscard]] bool is_series_image_name(std::string_view name);

/// Photographs a uniformly lit field of 320 x 240 pixels with the emulated sensor: one slot an
/// image, the whole array read in each. A colour filter array is left off. Images are 16-bit PNG
/// with the DN as they are. `advance` is called after each. \throws InputError if the sensor has
/// maps of unequal pixels, DeviceError.
void capture_flat_fields(const SensorParams& params, std::uint64_t seed,
                         const std::filesystem::path& folder, const std::function<void()>& advance);

/// Reads the images that a descriptor names and evaluates them; messages call it `place`. `advance`
/// is called after each image.
/// \throws InputError naming descriptor and line, or the image that cannot be used: unreadable, of
/// another size, or with a DN beyond the bits.
[[nodiscard]] emva1288::Evaluation evaluate_series(const std::filesystem::path& descriptor,
                                                   const std::string& place,
                                                   const std::function<void()>& advance);

/// The figures that an evaluation of this sensor would find without noise of its own. Defects
/// count: dead pixels lower the quantum efficiency and raise the PRNU, hot ones raise the DSNU.
[[nodiscard]] emva1288::CameraFigures configured_figures(const SensorParams& params);

}  // namespace stipple
