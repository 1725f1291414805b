#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/best/denoiser.h"

namespace stipple {

/// A network as denoiser. Its input has the shape 1 x (frames + 1) x rows x cols: the noisy frames
/// around a slot, those at the ends repeated, and a frame that holds sigma everywhere. Its output
/// is the frame of the slot, 1 x 1 x rows x cols. It gets each plane by itself; rows and columns
/// are filled up to multiples of 8 by the pixels of the border. The same bits for any number of
/// threads on one machine. `onnx`: bytes of the file `name`; `frames` is odd. \throws InputError
/// that names the file if it is no network that OpenCV reads; so does the denoiser, if the network
/// does not take or give these shapes. DeviceError as lazy_opencv.h.
[[nodiscard]] DenoiserMaker network_denoiser(const std::string& name,
                                             std::vector<std::uint8_t> onnx, int frames);

}  // namespace stipple
