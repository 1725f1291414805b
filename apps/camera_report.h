#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "emva1288/camera_figures.h"

namespace stipple {

/// What was measured, and what a sensor is configured to, if it is one of ours.
struct CameraReport {
    emva1288::Evaluation evaluation;
    std::optional<emva1288::CameraFigures> configured;
};

/// The keys of `characterize` in docs/cli.md.
[[nodiscard]] nlohmann::ordered_json camera_json(const CameraReport& report);

/// A table of the figures, with a warning where they are biased.
[[nodiscard]] std::string camera_text(const CameraReport& report);

/// Draws the photon transfer curve as photon_transfer.png and .svg. \throws DeviceError.
void draw_photon_transfer(const emva1288::Evaluation& evaluation,
                          const std::filesystem::path& folder);

}  // namespace stipple
