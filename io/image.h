#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/light.h"

namespace stipple {

/// What a image or a video says of its numbers, and of the camera that took it.
struct SourceTraits {
    bool gamma_coded = false;  ///< by what it declares or by its kind, no linear light
    bool floating = false;
    bool has_alpha = false;                     ///< which is left out
    std::optional<Transfer> declared = {};      ///< transfer function, if it is one of these
    std::string curve = {};                     ///< name of the declared one, of video
    bool bt2020 = false;                        ///< declares the primaries of BT.2020
    ColourFilter filter = ColourFilter::kNone;  ///< whose mosaic its one plane is
    std::optional<double> frames_hz = {};       ///< at which frames play or were taken
    std::optional<double> exposure_us = {};     ///< of a frame
};

/// One decoded image, order (plane, row, col). Integers are scaled to 0..1 (255 or 65535 = 1),
/// floating-point values are as the file holds them, unchecked.
struct Image {
    FrameShape shape;
    SourceTraits traits;
    std::vector<float> values;

    /// Takes the shape and makes room for its values.
    void resize(FrameShape new_shape) {
        shape = new_shape;
        values.resize(new_shape.sites());
    }
};

}  // namespace stipple
