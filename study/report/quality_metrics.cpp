#include "study/report/quality_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "study/report/chart.h"

namespace stipple {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::array<QualityMetric, 7> kMetrics{{
    {"psnr", "psnr_db", "PSNR", "linear", false, true, true,
     [](const VideoQuality& q) { return q.psnr_db; }},
    {"psnr-gamma", "psnr_gamma_db", "PSNR gamma", "clamped to 0..1, power 1/2.2", false, true, true,
     [](const VideoQuality& q) { return q.psnr_gamma_db; }},
    {"psnr-frames", "psnr_frame_mean_db", "PSNR frames", "linear, mean of the frames' values",
     false, true, false, [](const VideoQuality& q) { return q.psnr_frame_mean_db; }},
    {"pu21-psnr", "pu21_psnr_db", "PU21-PSNR", "of PU21 values", false, true, true,
     [](const VideoQuality& q) { return q.pu21_psnr_db; }},
    {"ssim", "ssim", "SSIM", "clamped to 0..1, power 1/2.2", true, true, true,
     [](const VideoQuality& q) { return q.ssim; }},
    {"pu21-ssim", "pu21_ssim", "PU21-SSIM", "of the PU21 values of luminance", true, false, true,
     [](const VideoQuality& q) { return q.pu21_ssim.value_or(kNone); }},
    {"pu21-csf-psnr", "pu21_csf_psnr_db", "PU21-CSF", "error weighted by contrast sensitivity",
     false, false, true, [](const VideoQuality& q) { return q.pu21_csf_psnr_db.value_or(kNone); }},
}};

/// What the figure depends on.
std::string conditions(const QualityMetric& metric, const QualityOptions& options) {
    std::string text(metric.text);
    if (metric.name == "psnr") text += fmt::format(", peak {:g}", options.peak);
    if (metric.name.starts_with("pu21"))
        text += fmt::format(", 1.0 = {:g} cd/m2", options.unit_cd_per_m2);
    if (metric.name == "pu21-csf-psnr")
        text += fmt::format(", {:g} pixels per degree", options.pixels_per_degree.value_or(0));
    return text;
}

/// As gnuplot reads it: it draws no point at infinity.
std::string chart_number(double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : "NaN";
}

}  // namespace

std::span<const QualityMetric> quality_metrics() {
    return kMetrics;
}

QualityMetrics chosen_metrics(const std::vector<std::string>& names) {
    QualityMetrics chosen;
    std::ranges::copy_if(kMetrics, std::back_inserter(chosen), [&](const QualityMetric& metric) {
        return names.empty() ? metric.by_default : std::ranges::count(names, metric.name) > 0;
    });
    return chosen;
}

bool has_metric(const QualityMetrics& metrics, std::string_view name) {
    return std::ranges::find(metrics, name, &QualityMetric::name) != metrics.end();
}

nlohmann::ordered_json metrics_json(const QualityMetrics& metrics, const VideoQuality& quality) {
    nlohmann::ordered_json json;
    for (const QualityMetric& metric : metrics)
        json[std::string(metric.key)] = metric.value(quality);
    return json;
}

std::string metrics_text(const QualityMetrics& metrics, const VideoQuality& quality,
                         const QualityOptions& options) {
    std::string text;
    for (const QualityMetric& metric : metrics) {
        const double value = metric.value(quality);
        const std::string number = metric.is_similarity ? fmt::format("{:7.4f}   ", value)
                                                        : fmt::format("{:7.2f} dB", value);
        text += fmt::format("{}{:<11} {}  {}", text.empty() ? "" : "\n", metric.title, number,
                            conditions(metric, options));
    }
    return text;
}

std::string table_csv(const FrameTable& table) {
    std::string text = "frame";
    for (const QualityMetric& metric : table.metrics)
        if (metric.of_a_frame) text += fmt::format(",{}", metric.key);
    text += "\r\n";
    for (std::size_t i = 0; i < table.frames.size(); ++i) {
        text += fmt::format("{}", table.first_frame + static_cast<std::int64_t>(i));
        for (const QualityMetric& metric : table.metrics)
            if (metric.of_a_frame) text += fmt::format(",{}", metric.value(table.frames[i]));
        text += "\r\n";
    }
    return text;
}

/// gnuplot chooses no range where nothing is finite, and ends.
std::string ranges_of(const FrameTable& table) {
    const auto has_point = [&](bool of_similarity) {
        return std::ranges::any_of(table.metrics, [&](const QualityMetric& metric) {
            return metric.of_a_frame && metric.is_similarity == of_similarity &&
                   std::ranges::any_of(table.frames, [&](const VideoQuality& frame) {
                       return std::isfinite(metric.value(frame));
                   });
        });
    };
    const double begin = static_cast<double>(table.first_frame) - 0.5;
    return fmt::format("set xrange [{}:{}]\n{}{}", begin,
                       begin + static_cast<double>(table.frames.size()),
                       has_point(false) ? "" : "set yrange [0:1]\n",
                       has_point(true) ? "set y2range [*:1]\n" : "set y2range [0:1]\n");
}

std::string table_chart(const FrameTable& table, std::string_view extension) {
    std::string commands = "$frames << END\n";
    for (std::size_t i = 0; i < table.frames.size(); ++i) {
        commands += fmt::format("{}", table.first_frame + static_cast<std::int64_t>(i));
        for (const QualityMetric& metric : table.metrics)
            commands += fmt::format(" {}", chart_number(metric.value(table.frames[i])));
        commands += '\n';
    }
    commands +=
        "END\n"
        "set title 'Quality of each frame'\nset xlabel 'frame'\nset grid\nset key outside right\n" +
        ranges_of(table);
    std::string plot;
    for (std::size_t i = 0; i < table.metrics.size(); ++i) {
        const QualityMetric& metric = table.metrics[i];
        if (!metric.of_a_frame) continue;
        plot += fmt::format(
            "{}$frames using 1:{} axes x1{} title '{}' with linespoints pointtype 7 pointsize 0.4 "
            "linewidth 2{}",
            plot.empty() ? "plot " : ", ", i + 2, metric.is_similarity ? "y2" : "y1", metric.title,
            metric.is_similarity ? " dashtype 2" : "");
        commands += metric.is_similarity ? "set y2label 'similarity'\nset y2tics\n"
                                         : "set ylabel 'dB'\nset ytics nomirror\n";
    }
    return draw_chart(extension, {}, commands + plot + "\n");
}

}  // namespace stipple
