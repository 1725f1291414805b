#include "apps/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/footage_formats.h"
#include "io/footage_reader.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// Of the frames read so far.
struct Light {
    std::int64_t frames = 0;
    float min = std::numeric_limits<float>::infinity();
    float max = 0;
    double sum_of_means = 0;

    void add(std::span<const float> frame) {
        const auto [low, high] = std::ranges::minmax(frame);
        min = std::min(min, low);
        max = std::max(max, high);
        sum_of_means +=
            std::accumulate(frame.begin(), frame.end(), 0.0) / static_cast<double>(frame.size());
        ++frames;
    }
    [[nodiscard]] double mean() const { return sum_of_means / static_cast<double>(frames); }
};

void pass_warnings_on(FootageReader& reader) {
    for (const Message& warning : reader.take_warnings()) say_warning(warning);
}

void read_all(FootageReader& reader, const std::string& source, const RunOptions& run,
              Light& light) {
    constexpr std::uint64_t kSiteBytes = 2 * sizeof(float);  // here and in the reader
    check_memory(kSiteBytes * reader.shape().sites(), source, "a frame", input_bytes(source));
    std::vector<float> frame(reader.shape().sites());
    Progress progress(run, "reading", reader.slots());
    while (reader.read(frame)) {
        throw_if_stopped();
        light.add(frame);
        progress.advance();
    }
}

std::optional<std::int64_t> announced_frames(const FootageReader& reader) {
    if (const auto slots = reader.slots()) return *slots;
    return reader.traits().announced_frames;
}

ordered_json footage_json(const FootageReader& reader, const Light& light, bool complete) {
    const FrameShape shape = reader.shape();
    const SourceInfo& traits = reader.traits();
    ordered_json json{{"kind", "footage"},
                      {"format", reader.kind()},
                      {"width", shape.cols},
                      {"height", shape.rows},
                      {"planes", shape.planes},
                      {"announced_frames", or_null(announced_frames(reader))},
                      {"frames", nullptr},
                      {"frames_hz", or_null(reader.frames_hz())},
                      {"exposure_us", or_null(traits.exposure_us)},
                      {"sample_format", or_null(traits.sample_format)},
                      {"bits", nullptr},
                      {"black_level_dn", or_null(traits.black_dn)},
                      {"white_level_dn", or_null(traits.white_dn)},
                      {"cfa", name_of(traits.filter)},
                      {"curve", or_null(traits.curve)},
                      {"gamma_coded", traits.gamma_coded},
                      {"alpha", traits.has_alpha},
                      {"min_light", nullptr},
                      {"mean_light", nullptr},
                      {"max_light", nullptr},
                      {"complete", complete}};
    if (traits.bits > 0) json["bits"] = traits.bits;
    if (light.frames == 0) return json;
    json["frames"] = light.frames;
    json["min_light"] = light.min;
    json["mean_light"] = light.mean();
    json["max_light"] = light.max;
    return json;
}

std::string frames_text(const FootageReader& reader, const Light& light, bool complete) {
    const FrameShape shape = reader.shape();
    std::string text = fmt::format("{} x {} x {} (width x height x planes), ", shape.cols,
                                   shape.rows, shape.planes);
    if (complete) return text + fmt::format("{} of them", light.frames);
    const auto announced = announced_frames(reader);
    return text +
           (announced ? fmt::format("{} announced", *announced) : "their number is not announced");
}

std::string rate_text(const FootageReader& reader, const Light& light, bool complete) {
    const auto hz = reader.frames_hz();
    if (!hz) return "not declared";
    return fmt::format(
        "{:.6g} per second{}", *hz,
        complete ? fmt::format(", {:.4g} s", static_cast<double>(light.frames) / *hz) : "");
}

std::string samples_text(const SourceInfo& traits) {
    std::string text = traits.sample_format;
    if (traits.bits > 0) text += fmt::format("{}{} bits", text.empty() ? "" : ", ", traits.bits);
    return text.empty() ? "not declared" : text;
}

std::string levels_text(const SourceInfo& traits) {
    const auto level = [](const std::optional<double>& dn) {
        return dn ? fmt::format("{:g} DN", *dn) : "not declared";
    };
    return fmt::format("black {}, white {}", level(traits.black_dn), level(traits.white_dn));
}

std::string transfer_text(const SourceInfo& traits) {
    if (traits.gamma_coded)
        return traits.curve.empty() ? "not declared; gamma-coded by its kind (--transfer)"
                                    : traits.curve + ", gamma-coded (--transfer)";
    if (traits.curve.empty()) return "not declared; numbers are taken as linear light";
    return traits.curve == "linear" ? "linear" : traits.curve + ", undone in reading";
}

std::string footage_text(const FootageReader& reader, const Light& light, bool complete) {
    const SourceInfo& traits = reader.traits();
    std::string text = fmt::format(
        "footage      {}\n"
        "frames       {}\n"
        "rate         {}\n"
        "samples      {}\n"
        "transfer     {}",
        reader.kind(), frames_text(reader, light, complete), rate_text(reader, light, complete),
        samples_text(traits), transfer_text(traits));
    if (traits.exposure_us) text += fmt::format("\nexposure     {:.6g} us", *traits.exposure_us);
    if (traits.black_dn || traits.white_dn) text += "\nlevels       " + levels_text(traits);
    if (traits.filter != ColourFilter::kNone)
        text += fmt::format("\nfilter       {}", name_of(traits.filter));
    if (traits.has_alpha) text += "\nalpha        left out";
    if (light.frames > 0)
        text += fmt::format("\nlight        {:.4g} to {:.4g}, mean {:.4g}, in the numbers as read",
                            light.min, light.max, light.mean());
    return text;
}

}  // namespace

bool is_footage(const std::string& source) {
    const std::filesystem::path path(source);
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        return path.filename().string().find('%') != std::string::npos;
    if (std::filesystem::is_directory(status)) return true;
    return is_footage_name(path);
}

void info_footage(const std::string& source, const std::optional<RawFormat>& raw, bool header_only,
                  const RunOptions& run) {
    FootageReader reader(source, {.transfer = Transfer::kLinear, .max_value = {}, .raw = raw});
    JsonFile json(run);
    pass_warnings_on(reader);
    Light light;
    std::optional<InputError> fault;
    try {
        if (!header_only) read_all(reader, source, run, light);
    } catch (const InputError& e) {
        fault = e;
    }
    pass_warnings_on(reader);
    const bool complete = !header_only && !fault;
    json.write(footage_json(reader, light, complete));
    run.say(footage_text(reader, light, complete));
    if (fault) throw InputError(*fault);
    run.say(header_only ? "condition    not checked"
                        : "condition    complete, all frames are read");
}

}  // namespace stipple
