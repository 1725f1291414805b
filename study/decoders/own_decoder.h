#pragma once

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "core/flux_video.h"

namespace stipple {

/// A decoding method that a program brings, which takes part beside those of Stipple.
struct OwnDecoder {
    /// The video of a stream: light in the units of the footage, a frame for each of its slots.
    /// `options` are the keys "decoder." of the point, lines of TOML. What it throws ends the
    /// exploration; an InputError is the problem of the point, as of a method that cannot decode a
    /// schedule.
    using Decode =
        std::function<FluxVideo(const std::filesystem::path& stream, const std::string& options)>;

    std::string name;  ///< value of the axis "method"
    Decode decode;
    /// Names what the results depend on besides the stream and the options; empty: not known, so
    /// that each run decodes again.
    std::string version = {};
};

/// \throws InputError if the name is that of a method of Stipple, is empty, longer than 64 bytes or
/// has control characters, or if there is no function.
void check_decoder(const OwnDecoder& decoder);

/// The result of an OwnDecoder is no video of its stream.
class DecoderFault : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// \throws DecoderFault naming the decoder if its video has another shape or other slots, or light
/// that is not finite.
void check_video(const OwnDecoder& decoder, const FluxVideo& video, int slots, FrameShape shape);

}  // namespace stipple
