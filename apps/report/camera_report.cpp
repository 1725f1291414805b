#include "apps/report/camera_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/report/chart.h"

namespace stipple {
namespace {

using emva1288::CameraFigures;

/// A figure, its name for programs, and how people read it.
struct Row {
    const char* key;
    const char* name;
    double CameraFigures::*figure;
    double scale;
    const char* unit;
};

constexpr Row kRows[] = {
    {"gain_dn_per_e", "system gain K", &CameraFigures::gain_dn_per_e, 1, "DN/e"},
    {"quantum_efficiency", "quantum efficiency", &CameraFigures::quantum_efficiency, 100, "%"},
    {"dark_noise_e", "dark noise", &CameraFigures::dark_noise_e, 1, "e"},
    {"saturation_e", "saturation capacity", &CameraFigures::saturation_e, 1, "e"},
    {"dsnu_e", "DSNU", &CameraFigures::dsnu_e, 1, "e"},
    {"prnu", "PRNU", &CameraFigures::prnu, 100, "%"},
    {"snr_max", "largest SNR", &CameraFigures::snr_max, 1, ""},
    {"sensitivity_threshold_p", "sensitivity threshold", &CameraFigures::sensitivity_threshold_p, 1,
     "photons"},
    {"dynamic_range", "dynamic range", &CameraFigures::dynamic_range, 1, ": 1"},
    {"linearity_error", "linearity error", &CameraFigures::linearity_error, 100, "%"}};

/// Share of zeros in a dark image whose black level is 3 sigma of the noise: Phi(-3). More zeros
/// mean that the noise is cut off.
constexpr double kCutOff = 0.00135;

nlohmann::ordered_json figures_json(const CameraFigures& figures) {
    auto json = nlohmann::ordered_json::object();  // [] of null aborts where memory runs out
    for (const Row& row : kRows) json[row.key] = figures.*row.figure;
    return json;
}

std::string row_text(const Row& row, const CameraReport& report) {
    const double measured = report.evaluation.figures.*row.figure;
    std::string text = fmt::format("{:<22}{:>12.4g}", row.name, measured * row.scale);
    if (report.configured) {
        const double expected = (*report.configured).*row.figure;
        text += fmt::format("{:>12.4g}", expected * row.scale);
        text += expected == 0 ? std::string(11, ' ')
                              : fmt::format("{:>+9.2f} %", 100 * (measured / expected - 1));
    }
    if (!std::string_view(row.unit).empty()) text += fmt::format("   {}", row.unit);
    return text + "\n";
}

}  // namespace

emva1288::CameraFigures configured_figures(const SensorParams& params) {
    const PhysicalTerms& terms = params.physical;
    const double alive = 1 - terms.dead_pixel_fraction;
    SensorParams hot = params;
    hot.physical.dark_current_e_per_s = terms.hot_pixel_dark_current;
    const double dark_e = params.dark_e_per_slot();
    const double hot_e = hot.dark_e_per_slot();
    const double share = terms.hot_pixel_fraction;
    const double read_e = params.temporal_read_noise_e();

    emva1288::CameraFigures f;
    f.gain_dn_per_e = 1 / params.gain_e_per_dn();
    f.quantum_efficiency = terms.quantum_efficiency * alive;
    f.dark_noise_e = std::sqrt(read_e * read_e + dark_e + share * hot_e);
    f.saturation_e = params.saturation_e();
    f.dsnu_e = std::sqrt(terms.dsnu_e * terms.dsnu_e + terms.column_noise_e * terms.column_noise_e +
                         share * (1 - share) * hot_e * hot_e);
    f.prnu = std::sqrt((1 + terms.prnu * terms.prnu) / alive - 1);
    f.snr_max = std::sqrt(f.saturation_e);
    const double noise2_e2 =
        f.dark_noise_e * f.dark_noise_e + params.gain_e_per_dn() * params.gain_e_per_dn() / 12;
    f.sensitivity_threshold_p = (std::sqrt(noise2_e2 + 0.25) + 0.5) / f.quantum_efficiency;
    f.dynamic_range = f.saturation_e / f.quantum_efficiency / f.sensitivity_threshold_p;
    return f;
}

nlohmann::ordered_json camera_json(const CameraReport& report) {
    const auto& [figures, transfer, saturation, dark_mean, dark_variance, zero_fraction] =
        report.evaluation;
    nlohmann::ordered_json json{{"measured", figures_json(figures)}};
    if (report.configured) json["configured"] = figures_json(*report.configured);
    json["dark_mean_dn"] = dark_mean;
    json["dark_deviation_dn"] = std::sqrt(dark_variance);
    json["dark_zero_fraction"] = zero_fraction;
    json["biased"] = zero_fraction > kCutOff;
    auto points = nlohmann::ordered_json::array();
    for (const emva1288::TransferPoint& point : transfer)
        points.push_back({point.photons, point.mean_dn, point.variance_dn2});
    json["photon_transfer"] = points;
    json["saturation_point"] = saturation;
    return json;
}

std::string camera_text(const CameraReport& report) {
    std::string text = fmt::format("{:<22}{:>12}", "", "measured");
    if (report.configured) text += fmt::format("{:>12}{:>11}", "configured", "deviation");
    text += '\n';
    for (const Row& row : kRows) text += row_text(row, report);
    text.pop_back();
    return text;
}

std::string bias_warning(const emva1288::Evaluation& evaluation) {
    if (evaluation.dark_zero_fraction <= kCutOff) return {};
    return fmt::format(
        "{:.1f} % of the dark values are 0: the black level is too low, so the converter cuts the "
        "dark noise off and the figures are biased (of normal noise around 0 it leaves the mean "
        "0.40 sigma and the deviation 0.58 sigma). A black level of 4 sigma is enough; the "
        "emulated sensor takes one in mode \"physical\"",
        100 * evaluation.dark_zero_fraction);
}

std::vector<PhotonTransferChart> photon_transfer_charts(const emva1288::Evaluation& evaluation) {
    const auto& points = evaluation.transfer;
    const double saturation_dn = points[evaluation.saturation].mean_dn;
    std::string commands = "$points << END\n";
    for (const emva1288::TransferPoint& point : points)
        commands += fmt::format("{} {}\n", point.mean_dn, point.variance_dn2);
    commands += fmt::format(
        "END\n"
        "set title 'Photon transfer: K = {:.4g} DN/e'\n"
        "set xlabel 'mean less dark (DN)'\n"
        "set ylabel 'variance less dark (DN^2)'\n"
        "set key top left\n"
        "set grid\n"
        "set xrange [0:*]\nset yrange [0:*]\n"
        "set arrow from {},graph 0 to {},graph 1 nohead dashtype 2 linecolor rgb 'gray40'\n"
        "set label 'saturation' at {},graph 0.05 right offset -1,0 textcolor rgb 'gray40'\n"
        "plot [0:*] {}*x*(x<={}?1:NaN) title 'fit, 0 to 70 % of saturation' linewidth 2 "
        "linecolor rgb '#c04000', "
        "$points title 'pairs of images' with points pointtype 7 pointsize 0.6 "
        "linecolor rgb '#004080'\n",
        evaluation.figures.gain_dn_per_e, saturation_dn, saturation_dn, saturation_dn,
        evaluation.figures.gain_dn_per_e, 0.7 * saturation_dn);
    std::vector<PhotonTransferChart> charts;
    for (const char* extension : {".png", ".svg"})
        charts.push_back(
            {std::string("photon_transfer") + extension, draw_chart(extension, {}, commands)});
    return charts;
}

}  // namespace stipple
