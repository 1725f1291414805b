#pragma once

#include "tests/fuzz/framed_file.h"

namespace stipple {

/// PNG: signature, chunks.
extern const FramedFormat kPngFormat;

}  // namespace stipple
