#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "metrics/emva1288/camera_figures.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Measured figures; and for an emulated sensor the figures that follow from its parameters.
struct CameraReport {
    emva1288::Evaluation evaluation;
    std::optional<emva1288::CameraFigures> configured;
};

/// The figures that an evaluation of this sensor would find without noise of its own. Defects
/// count: dead pixels lower the quantum efficiency and raise the PRNU, hot ones raise the DSNU.
[[nodiscard]] emva1288::CameraFigures configured_figures(const SensorParams& params);

/// The keys of `characterize` in docs/cli.md.
[[nodiscard]] nlohmann::ordered_json camera_json(const CameraReport& report);

/// A table of the figures.
[[nodiscard]] std::string camera_text(const CameraReport& report);

/// Says how the figures are biased; empty if they are not.
[[nodiscard]] std::string bias_warning(const emva1288::Evaluation& evaluation);

/// A chart as the content of a file.
struct PhotonTransferChart {
    std::string name;
    std::string content;
};

/// The photon transfer curve as photon_transfer.png and .svg. \throws as draw_chart.
[[nodiscard]] std::vector<PhotonTransferChart> photon_transfer_charts(
    const emva1288::Evaluation& evaluation);

}  // namespace stipple
