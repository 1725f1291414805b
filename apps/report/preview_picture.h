#pragma once

#include <filesystem>

#include "decoder/preview.h"

namespace stipple {

/// Replaces `file` at once as a whole: a .png with what is too bright in red and a line of text
/// above, or a .npy of linear light, (1, H, W) or (1, H, W, 3). \throws InputError, DeviceError.
void write_preview(const std::filesystem::path& file, const PreviewFrame& frame);

}  // namespace stipple
