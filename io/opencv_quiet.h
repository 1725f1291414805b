#pragma once

namespace stipple {

/// Stops OpenCV and the FFmpeg behind it from writing to stderr; our own errors say what is wrong.
/// Call before the first use of an image or video file.
void silence_opencv();

}  // namespace stipple
