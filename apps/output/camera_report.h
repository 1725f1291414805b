#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/metrics/emva1288/camera_figures.h"

namespace stipple {

/// Measured figures; and for an emulated sensor the figures that follow from its parameters.
struct CameraReport {
    emva1288::Evaluation evaluation;
    std::optional<emva1288::CameraFigures> configured;
};

/// The keys of `characterize` in docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json camera_json(const CameraReport& report);

/// A table of the figures.
[[nodiscard]] std::string camera_text(const CameraReport& report);

/// A chart as the content of a file.
struct PhotonTransferChart {
    std::string name;
    std::string content;
};

/// The photon transfer curve as photon_transfer.png and .svg. \throws as draw_chart.
[[nodiscard]] std::vector<PhotonTransferChart> photon_transfer_charts(
    const emva1288::Evaluation& evaluation);

}  // namespace stipple
