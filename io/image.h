#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "core/light.h"
#include "core/message.h"

namespace stipple {

/// What an image or a video says of its numbers, and of the camera that took it.
struct SourceInfo {
    bool gamma_coded = false;  ///< by what it declares or by its kind, no linear light
    bool floating = false;
    bool has_alpha = false;                     ///< which is left out
    std::optional<Transfer> declared = {};      ///< transfer function, if it is one of these
    bool bt2020 = false;                        ///< declares the primaries of BT.2020
    ColourFilter filter = ColourFilter::kNone;  ///< whose mosaic its one plane is
    std::optional<double> frames_hz = {};       ///< at which frames play or were taken
    std::optional<double> exposure_us = {};     ///< of a frame
    std::optional<std::int64_t> announced_frames = {};  ///< by the container of a video
    std::string sample_format = {};       ///< as files and libraries name it: "uint16", "yuv420p"
    int bits = 0;                         ///< significant bits of a sample; 0: unknown or floating
    std::optional<double> black_dn = {};  ///< that the file declares, or its kind
    std::optional<double> white_dn = {};
    std::string curve = {};      ///< from light to numbers, declared; undone unless `gamma_coded`
    std::string primaries = {};  ///< of a video, if far from those of Rec. 709
    std::string unequal_times = {};  ///< how far apart frames are, if unequally: "1 to 2 s apart"
    std::vector<Message> warnings = {};  ///< what else it declares that users should know
};

/// One decoded image, order (plane, row, col). Integers are scaled to 0..1 (255 or 65535 = 1),
/// floating-point values are as the file holds them, unchecked.
struct Image {
    FrameShape shape;
    SourceInfo traits;
    std::vector<float> values;

    /// Takes the shape and makes room for its values.
    void resize(FrameShape new_shape) {
        shape = new_shape;
        values.resize(new_shape.sites());
    }
};

}  // namespace stipple
