#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "capture/camera_search.h"
#include "capture/capture_figures.h"
#include "core/text.h"
#include "stream/plain_text.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

struct FeaturesOptions {
    std::string address;
    std::string pattern;  ///< empty: all
};

ordered_json features_json(const FeaturesOptions& options,
                           const std::vector<CameraFeature>& features) {
    auto list = ordered_json::array();
    for (const CameraFeature& feature : features)
        list.push_back(json_of([&](const auto& add) { visit_feature_figures(feature, add); }));
    return {{"address", options.address}, {"features", list}};
}

/// What the feature takes: "0..255 step 5", or its choices.
std::string range_of(const CameraFeature& feature) {
    if (!feature.choices.empty()) return joined(feature.choices);
    if (!feature.minimum && !feature.maximum) return {};
    std::string text =
        fmt::format("{}..{}", feature.minimum.value_or(""), feature.maximum.value_or(""));
    if (feature.increment && feature.increment != "1") text += " step " + *feature.increment;
    return text;
}

std::string value_of(const CameraFeature& feature) {
    std::string text = feature.value.value_or("-");
    if (!feature.unit.empty()) text += " " + feature.unit;
    return text;
}

std::string features_text(const std::vector<CameraFeature>& features) {
    constexpr std::size_t kMaxWidth = 40;
    const std::size_t name_width = column_width(features, &CameraFeature::name, kMaxWidth);
    const std::size_t value_width = column_width(features, value_of, kMaxWidth);
    std::string text;
    for (const CameraFeature& feature : features) {
        std::string line =
            fmt::format("{:<{}}  {}  {:<8}  {:<{}}  {}", feature.name, name_width, feature.access,
                        feature.type, value_of(feature), value_width, range_of(feature));
        std::ranges::replace(line, '\n', ' ');  // one feature a line, whatever the camera says
        line.erase(line.find_last_not_of(' ') + 1);
        text += (text.empty() ? "" : "\n") + line;
    }
    return terminal_text(text);
}

void list_features(const FeaturesOptions& options, const RunOptions& run) {
    JsonFile json(run);
    const std::vector<CameraFeature> features =
        interruptible([options] { return camera_features(options.address, options.pattern); });
    json.write(features_json(options, features));
    run.say(features.empty() ? "no features" : features_text(features));
}

}  // namespace

void add_capture_features(Command& capture, Action& action) {
    Command command = capture.add_command(
        "features", "Settings of a camera: values, units, ranges, choices, access");
    const auto options = std::make_shared<FeaturesOptions>();
    command.add_option("ADDRESS", options->address, "gige:IP, usb:SERIAL or v4l2:/dev/videoN")
        .required();
    command
        .add_option("PATTERN", options->pattern, "part of a name, or a name with wildcards * ? []")
        .default_text("all");
    command.footer(
        "Examples:\n"
        "  stipple capture features gige:192.168.0.5\n"
        "  stipple capture features gige:192.168.0.5 exposure\n"
        "  stipple capture features v4l2:/dev/video0 'gain*' --json -\n"
        "rw: can be set by --set camera.NAME=VALUE, ro: read only or locked now, wo: write only,\n"
        "na: not available now.");
    set_action(command, action, options, list_features);
}

}  // namespace stipple
