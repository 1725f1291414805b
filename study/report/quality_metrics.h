#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "study/metrics/video_quality.h"

namespace stipple {

/// A figure of `stipple compare`.
struct QualityMetric {
    std::string_view name;   ///< of `--metric`
    std::string_view key;    ///< in JSON, and the column of a table
    std::string_view title;  ///< at the beginning of its line
    std::string_view text;   ///< what it is
    bool is_similarity;      ///< up to 1; else in dB
    bool by_default;
    bool of_a_frame;  ///< whether it has a meaning for each frame
    double (*value)(const VideoQuality& quality);
};
using QualityMetrics = std::vector<QualityMetric>;

/// All, in the order of their lines.
[[nodiscard]] std::span<const QualityMetric> quality_metrics();

/// Those of these names, of no names the default ones; each once. Precondition: they exist.
[[nodiscard]] QualityMetrics chosen_metrics(const std::vector<std::string>& names);

[[nodiscard]] bool has_metric(const QualityMetrics& metrics, std::string_view name);

/// Their figures under their keys.
[[nodiscard]] nlohmann::ordered_json metrics_json(const QualityMetrics& metrics,
                                                  const VideoQuality& quality);

/// A line each.
[[nodiscard]] std::string metrics_text(const QualityMetrics& metrics, const VideoQuality& quality,
                                       const QualityOptions& options);

/// Figures frame by frame.
struct FrameTable {
    QualityMetrics metrics;
    std::vector<VideoQuality> frames;
    std::int64_t first_frame = 0;  ///< number of the first one
};

/// Comma-separated values (RFC 4180) with a line of names. Infinity is "inf", an SSIM of frames
/// smaller than its window "nan".
[[nodiscard]] std::string table_csv(const FrameTable& table);

/// The content of a chart file, dB on the left axis, similarities on the right one. \throws as
/// draw_chart.
[[nodiscard]] std::string table_chart(const FrameTable& table, std::string_view extension);

/// The figures of a comparison under the names of docs/outputs.md.
[[nodiscard]] nlohmann::ordered_json quality_json(const VideoQuality& quality);

}  // namespace stipple
