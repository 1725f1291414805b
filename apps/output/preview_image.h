#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "decoder/live_preview.h"

namespace stipple {

/// Replaces `file` at once as a whole: a .png with saturated pixels in red and a line of text
/// above, or a .npy of linear light, (1, H, W) or (1, H, W, 3). \throws InputError, DeviceError.
void write_preview(const std::filesystem::path& file, const PreviewFrame& frame);

/// Statistics of the finished preview `file`: the key `preview` of docs/outputs.md,
/// and the same for people.
[[nodiscard]] nlohmann::ordered_json preview_json(const std::string& file,
                                                  const LivePreview& preview);
[[nodiscard]] std::string preview_text(const std::string& file, const LivePreview& preview);

}  // namespace stipple
