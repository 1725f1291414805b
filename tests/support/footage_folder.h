#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace stipple {

/// The folder of real footage: $STIPPLE_FOOTAGE, or shared/footage beside the project. It may be
/// absent.
[[nodiscard]] std::filesystem::path footage_folder();

/// A clip of that folder; the folder itself for an empty name. Nothing if it is absent, so that its
/// test is skipped. \throws std::runtime_error if it is absent although STIPPLE_FOOTAGE is set: the
/// test fails.
[[nodiscard]] std::optional<std::filesystem::path> footage_clip(const std::string& name);

}  // namespace stipple
