#include "apps/output/camera_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "study/report/chart.h"

namespace stipple {
namespace {

using emva1288::CameraFigures;

/// How people read a figure.
struct Row {
    const char* name;
    double CameraFigures::*figure;
    double scale;
    const char* unit;
};

constexpr Row kRows[] = {
    {"system gain K", &CameraFigures::gain_dn_per_e, 1, "DN/e"},
    {"quantum efficiency", &CameraFigures::quantum_efficiency, 100, "%"},
    {"dark noise", &CameraFigures::dark_noise_e, 1, "e"},
    {"saturation capacity", &CameraFigures::saturation_e, 1, "e"},
    {"DSNU", &CameraFigures::dsnu_e, 1, "e"},
    {"  of rows", &CameraFigures::dsnu_row_e, 1, "e"},
    {"  of columns", &CameraFigures::dsnu_column_e, 1, "e"},
    {"  of pixels", &CameraFigures::dsnu_pixel_e, 1, "e"},
    {"  without shading", &CameraFigures::dsnu_high_pass_e, 1, "e"},
    {"PRNU", &CameraFigures::prnu, 100, "%"},
    {"  of rows", &CameraFigures::prnu_row, 100, "%"},
    {"  of columns", &CameraFigures::prnu_column, 100, "%"},
    {"  of pixels", &CameraFigures::prnu_pixel, 100, "%"},
    {"  without shading", &CameraFigures::prnu_high_pass, 100, "%"},
    {"maximum SNR", &CameraFigures::snr_max, 1, ""},
    {"sensitivity threshold", &CameraFigures::sensitivity_threshold_p, 1, "photons"},
    {"dynamic range", &CameraFigures::dynamic_range, 1, ": 1"},
    {"linearity error", &CameraFigures::linearity_error, 100, "%"}};

nlohmann::ordered_json figures_json(const CameraFigures& figures) {
    auto json = nlohmann::ordered_json::object();  // [] of null aborts where memory runs out
    for (const auto& [key, figure] : emva1288::kNamedFigures)
        json[std::string(key)] = figures.*figure;
    return json;
}

nlohmann::ordered_json histogram_json(const emva1288::DeviationHistogram& histogram) {
    return {{"first", histogram.first},
            {"width", histogram.width},
            {"pixels", histogram.pixels},
            {"normal", histogram.normal},
            {"accumulated_width", histogram.accumulated_width},
            {"at_least", histogram.at_least}};
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

nlohmann::ordered_json camera_json(const CameraReport& report) {
    const auto& [figures, transfer, saturation, dark_mean, dark_variance, zero_fraction,
                 dark_deviations, bright_deviations] = report.evaluation;
    nlohmann::ordered_json json{{"measured", figures_json(figures)}};
    if (report.configured) json["configured"] = figures_json(*report.configured);
    json["notes"] = emva1288::figure_notes(report.evaluation.figures, report.configured);
    json["dark_mean_dn"] = dark_mean;
    json["dark_deviation_dn"] = std::sqrt(dark_variance);
    json["dark_zero_fraction"] = zero_fraction;
    json["biased"] = emva1288::is_biased(report.evaluation);
    auto points = nlohmann::ordered_json::array();
    for (const emva1288::TransferPoint& point : transfer)
        points.push_back({point.photons, point.mean_dn, point.variance_dn2});
    json["photon_transfer"] = points;
    json["saturation_point"] = saturation;
    json["dark_deviations"] = histogram_json(dark_deviations);
    json["bright_deviations"] = histogram_json(bright_deviations);
    return json;
}

std::string camera_text(const CameraReport& report) {
    std::string text = fmt::format("{:<22}{:>12}", "", "measured");
    if (report.configured) text += fmt::format("{:>12}{:>11}", "configured", "deviation");
    text += '\n';
    for (const Row& row : kRows) text += row_text(row, report);
    for (const std::string& note :
         emva1288::figure_notes(report.evaluation.figures, report.configured))
        text += note + "\n";
    text.pop_back();
    return text;
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
