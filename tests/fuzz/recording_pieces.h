#pragma once

#include "tests/fuzz/framed_file.h"

namespace stipple {

/// The recording of a camera: magic, blocks.
extern const FramedFormat kRecordingFormat;

}  // namespace stipple
