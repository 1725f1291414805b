#include "apps/run_report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/report/json_figures.h"
#include "apps/report/stream_text.h"
#include "apps/run_report/plane_code.h"
#include "apps/run_report/report_page.h"
#include "apps/run_report/schedule_lanes.h"
#include "apps/run_report/stream_loads.h"
#include "apps/run_report/stream_samples.h"
#include "core/error.h"
#include "core/version.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "io/tone_map.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

constexpr int kLanes = 12;               ///< pixels of the schedule's diagram
constexpr std::int64_t kLaneSlots = 64;  ///< the most slots of it

[[noreturn]] void fail_size(std::uint64_t most, std::string_view content) {
    throw InputError(
        "--max-size",
        fmt::format("{} do not fit into {:.1f} MB; allow more, or show less with --crop "
                    "or --until",
                    content, 1e-6 * static_cast<double>(most)));
}

/// Which plane of colour each pixel of a 2 x 2 cell measures; null without a filter array.
ordered_json filter_json(ColourFilter cfa) {
    if (cfa == ColourFilter::kNone) return nullptr;
    return {colour_plane(cfa, 0, 0), colour_plane(cfa, 0, 1), colour_plane(cfa, 1, 0),
            colour_plane(cfa, 1, 1)};
}

}  // namespace

/// What a report shows of a stream.
struct RunReport::Run {
    Run(const std::filesystem::path& file, std::string run_name, const PixelArea& area)
        : reader(file),
          name(std::move(run_name)),
          samples(reader.header(), area),
          loads(reader.header()) {}

    void read(const RunReportOptions& options);
    [[nodiscard]] ordered_json json() const;

    StreamReader reader;
    std::string name;
    StreamSamples samples;
    StreamLoads loads;
};

void RunReport::Run::read(const RunReportOptions& options) {
    for (SamplePacket packet; reader.next(packet) && packet.slot < options.slots;) {
        samples.add(packet);
        loads.add(packet);
        if (samples.bytes() > options.max_bytes)
            fail_size(options.max_bytes, "the samples of " + name);
    }
    samples.finish();
}

ordered_json RunReport::Run::json() const {
    const StreamHeader& header = reader.header();
    const std::string command = command_of(header.provenance);
    ordered_json json{{"name", name}, {"stream", stream_json(header, reader.report())}};
    json["command"] = or_null(command);
    json["filter"] = filter_json(header.cfa);
    json["samples"] = samples.json();
    json["loads"] = loads.json();
    json["lanes"] = lanes_json(header.schedule, header.shape, kLanes,
                               std::min(std::max(loads.slots(), std::int64_t{1}), kLaneSlots));
    return json;
}

RunReport::RunReport(RunReportOptions options, FrameShape shape, const FluxVideo* truth)
    : options_(std::move(options)),
      shape_(shape),
      area_(report_area(shape, options_.area)),
      truth_slots_(truth == nullptr ? 0 : truth->slots()),
      videos_(shape, area_, options_.quality, truth) {
    if (area_.rows < shape.rows || area_.cols < shape.cols)
        notes_.push_back(fmt::format(
            "The pictures show {} x {} of {} x {} pixels, from column {} and row {} on (report "
            "--crop).",
            area_.cols, area_.rows, shape.cols, shape.rows, area_.first_col, area_.first_row));
    if (truth == nullptr) return;
    videos_.add({"truth", "the light that the sensor saw", {}});
    for (int slot = 0; slot < truth->slots(); ++slot) put(0, slot, truth->frame(slot));
}

RunReport::~RunReport() = default;

std::size_t RunReport::add_run(const std::filesystem::path& stream, const std::string& name) {
    auto run = std::make_unique<Run>(stream, name, area_);
    const FrameShape shape = decoded_shape(run->reader.header());
    if (shape != shape_)
        throw InputError(stream.string(),
                         fmt::format("has frames of {} x {} x {} (width x height x planes), the "
                                     "report has {} x {} x {}",
                                     shape.cols, shape.rows, shape.planes, shape_.cols, shape_.rows,
                                     shape_.planes));
    run->read(options_);
    slots_ = std::max(slots_, run->loads.slots());
    if (const auto all = run->reader.slots(); all && *all > options_.slots)
        notes_.push_back(fmt::format("{}: the first {} of {} slots are shown (--until).", name,
                                     options_.slots, *all));
    if (!undamaged(run->reader.report()))
        notes_.push_back(
            fmt::format("{}: the stream is damaged; its whole samples are shown.", name));
    runs_.push_back(std::move(run));
    return runs_.size() - 1;
}

void RunReport::put(std::size_t video, std::int64_t slot, std::span<const float> frame) {
    if (slot >= options_.slots) return;
    videos_.put(video, slot, frame);
    slots_ = std::max(slots_, slot + 1);
    // So that memory is bounded too.
    while (videos_.bytes() > options_.max_bytes && videos_.step() < slots_) videos_.halve();
}

void RunReport::set_camera(const ordered_json& camera) {
    camera_ = std::make_unique<ordered_json>(camera);
}

void RunReport::fit() {
    if (truth_slots_ > 0 && truth_slots_ < slots_)
        notes_.push_back(fmt::format("The truth has {} of {} slots; quality is of these.",
                                     truth_slots_, slots_));
    std::size_t beside = report_page(options_.title, json(), {}).size();
    for (const auto& run : runs_) beside += run->samples.bytes();
    while (beside + videos_.bytes() > options_.max_bytes && videos_.step() < slots_)
        videos_.halve();
    if (beside + videos_.bytes() > options_.max_bytes)
        fail_size(options_.max_bytes, "a picture of each video and all samples");
    const std::int64_t step = videos_.step();
    if (step == 1) return;
    notes_.push_back(fmt::format(
        "Pictures are of every {}{} slot only, to stay within {:.0f} MB (--max-size); samples and "
        "quality are of all slots.",
        step, step == 2 ? "nd" : "th", 1e-6 * static_cast<double>(options_.max_bytes)));
}

std::string RunReport::damage() const {
    std::string text;
    for (const auto& run : runs_)
        if (const StreamReport& found = run->reader.report(); !undamaged(found))
            text += fmt::format("\n{}: {}", run->name, damage_text(found));
    return text;
}

ordered_json empty_report_json(const std::string& title, const std::string& command) {
    return {{"program", fmt::format("stipple {}", version())},
            {"title", title},
            {"command", command},
            {"notes", ordered_json::array()},
            {"videos", ordered_json::array()},
            {"runs", ordered_json::array()},
            {"camera", nullptr}};
}

ordered_json RunReport::json() const {
    ordered_json json = empty_report_json(options_.title, options_.command);
    json["truth"] = truth_slots_ > 0 ? ordered_json(0) : ordered_json();
    json["notes"] = notes_;
    json["featured"] = featured_;
    json["slots"] = slots_;
    json["picture_step"] = videos_.step();
    json["area"] = {{"rows", area_.rows},
                    {"cols", area_.cols},
                    {"planes", shape_.planes},
                    {"first_row", area_.first_row},
                    {"first_col", area_.first_col}};
    json["light_code"] = {{"darkest", kDarkestCodedLight}, {"codes_per_stop", kCodesPerStop}};
    json["white_light"] = kWhiteLight;
    json["quality_options"] = {{"margin", options_.quality.margin},
                               {"max_value", nullptr},
                               {"peak", options_.quality.peak},
                               {"cd_per_unit", options_.quality.unit_cd_per_m2}};
    if (options_.quality.max_value)
        json["quality_options"]["max_value"] = *options_.quality.max_value;
    json["videos"] = videos_.json();
    for (const auto& run : runs_) json["runs"].push_back(run->json());
    if (camera_) json["camera"] = *camera_;
    return json;
}

std::string RunReport::page() {
    const ordered_json data = json();
    auto planes = videos_.take_planes();
    for (std::size_t r = 0; r < runs_.size(); ++r)
        for (const PackedPlane& plane : runs_[r]->samples.planes())
            planes.push_back({fmt::format("r{}{}", r, plane.id), plane.text});
    return report_page(options_.title, data, planes);
}

double brightest_light(const StreamHeader& header) {
    const ExposureSchedule& schedule = header.schedule;
    int shortest = kMaxExposureSlots;
    for (int row = 0; row < std::min(schedule.tile_rows(), header.shape.rows); ++row)
        for (int col = 0; col < std::min(schedule.tile_cols(), header.shape.cols); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col))
                shortest = std::min(shortest, exposure.light_slots());
    const PixelResponses responses(header.calibration);
    double brightest = 0;
    const CalibrationTile& tile = header.calibration.tile;
    for (int row = 0; row < std::max(tile.rows, 1); ++row)
        for (int col = 0; col < std::max(tile.cols, 1); ++col)
            brightest =
                std::max(brightest, static_cast<double>(responses.at(row, col).light(
                                        std::numeric_limits<std::uint16_t>::max(), shortest)));
    return brightest / shortest;
}

}  // namespace stipple
