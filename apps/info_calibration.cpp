#include "apps/info.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "calibration/calibration_file.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

nlohmann::ordered_json json_of(const MapFigures& figures) {
    return {{"mean", figures.mean}, {"deviation", figures.deviation}};
}

}  // namespace

void info_calibration(const std::string& file, const RunOptions& run) {
    JsonFile json(run);
    const ChipCalibration c = read_chip_calibration(file);
    const ChipFigures figures = chip_figures(c);
    const double noise_dn = std::sqrt(figures.readout_noise_dn2.mean);
    const std::vector<float>& linear = c.response.linear_dn;
    nlohmann::ordered_json response;  // null: linear
    if (!linear.empty())
        response = {{"full_scale_linear_dn", linear.back()},
                    {"full_scale_error_dn", std::sqrt(c.response.variance_dn2.back())}};
    nlohmann::ordered_json device_id;
    if (c.chip.device_id) device_id = *c.chip.device_id;
    json.write({{"kind", "calibration"},
                {"sensor", c.chip.name},
                {"device_id", device_id},
                {"rows", c.shape.rows},
                {"cols", c.shape.cols},
                {"planes", c.shape.planes},
                {"cfa", name_of(c.cfa)},
                {"bit_depth", c.bit_depth},
                {"flats", c.flats},
                {"darks", c.darks},
                {"gain", json_of(figures.gain)},
                {"gain_error", figures.gain_error},
                {"offset_dn", json_of(figures.offset_dn)},
                {"dark_dn_per_s", json_of(figures.dark_dn_per_s)},
                {"readout_noise_dn", noise_dn},
                {"response", response},
                {"defects", figures.defects}});
    run.say(fmt::format(
        "calibration  {} x {} pixels, {} of {} bits{}{}\n"
        "frames       {}, {}\n"
        "gain         1 +- {}, uncertainty {}\n"
        "offset       {} +- {} DN\n"
        "dark current {} +- {} DN/s\n"
        "noise        {} DN without light\n"
        "response     {}\n"
        "defects      {}",
        c.shape.cols, c.shape.rows, counted(c.shape.planes, "plane"), c.bit_depth,
        c.chip.name.empty() ? "" : fmt::format(", sensor {}", terminal_text(c.chip.name)),
        c.chip.device_id ? fmt::format(", device id {}", *c.chip.device_id) : "",
        counted(c.flats, "flat"), counted(c.darks, "dark"), rounded(figures.gain.deviation),
        rounded(figures.gain_error), rounded(figures.offset_dn.mean),
        rounded(figures.offset_dn.deviation), rounded(figures.dark_dn_per_s.mean),
        rounded(figures.dark_dn_per_s.deviation), rounded(noise_dn),
        linear.empty() ? "linear"
                       : fmt::format("table; {} DN stand for {} linear DN", linear.size() - 1,
                                     rounded(static_cast<double>(linear.back()))),
        figures.defects));
}

}  // namespace stipple
