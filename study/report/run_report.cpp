#include "study/report/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "core/version.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"
#include "readout/provenance.h"
#include "stream/stream_figures.h"
#include "stream/stream_reader.h"
#include "study/report/json_figures.h"
#include "study/report/report_page.h"
#include "study/report/report_videos.h"
#include "study/report/stream_samples.h"
#include "study/report/stream_text.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

[[noreturn]] void fail_size(std::uint64_t most, std::string_view content) {
    throw InputError(Parameter{"max_size"},
                     fmt::format("{} do not fit into {:.1f} MB; allow more, or show less with ",
                                 content, 1e-6 * static_cast<double>(most)) +
                         Parameter{"crop"} + " or " + Parameter{"until"});
}

ordered_json empty_report(const std::string& title, const std::string& command) {
    return {{"program", fmt::format("stipple {}", version())},
            {"title", title},
            {"command", command},
            {"notes", ordered_json::array()},
            {"videos", ordered_json::array()},
            {"runs", ordered_json::array()},
            {"camera", nullptr}};
}

ordered_json parsed_camera(const std::string& text) {
    ordered_json camera = ordered_json::parse(text, nullptr, false);
    if (camera.is_discarded()) throw InputError("camera figures", "invalid JSON");
    return camera;
}

/// What a report shows of a stream.
struct Run {
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

void Run::read(const RunReportOptions& options) {
    for (SamplePacket packet; reader.next(packet) && packet.slot < options.slots;) {
        samples.add(packet);
        loads.add(packet);
        if (samples.bytes() > options.max_bytes)
            fail_size(options.max_bytes, "the samples of " + name);
    }
    samples.finish();
}

ordered_json Run::json() const {
    ordered_json json = run_json(name, reader.header(), reader.report(), loads.slots());
    json["samples"] = samples.json();
    json["loads"] = loads.json();
    return json;
}

}  // namespace

struct RunReport::Impl {
    Impl(RunReportOptions report_options, FrameShape frame, const FluxVideo* truth)
        : options(std::move(report_options)),
          shape(frame),
          area(report_area(shape, options.area)),
          truth_slots(truth == nullptr ? 0 : truth->slots()),
          videos(shape, area, options.quality, truth) {}

    [[nodiscard]] ordered_json data() const;
    void note_differences(const Run& run);

    RunReportOptions options;
    FrameShape shape;
    PixelArea area;
    std::int64_t truth_slots;  ///< 0: there is no truth
    std::size_t featured = 0;
    ReportVideos videos;
    std::vector<std::unique_ptr<Run>> runs;
    ordered_json camera;     ///< null: none
    std::int64_t slots = 0;  ///< of the longest video or stream
    std::vector<std::string> notes;
};

ordered_json RunReport::Impl::data() const {
    ordered_json json = empty_report(options.title, options.command);
    json["truth"] = truth_slots > 0 ? ordered_json(0) : ordered_json();
    json["notes"] = notes;
    json["featured"] = featured;
    json["slots"] = slots;
    json["picture_step"] = videos.step();
    json.update(pictures_json(shape, area));
    json["quality_options"] = {{"margin", options.quality.margin},
                               {"max_value", nullptr},
                               {"peak", options.quality.peak},
                               {"cd_per_unit", options.quality.unit_cd_per_m2}};
    if (options.quality.max_value)
        json["quality_options"]["max_value"] = *options.quality.max_value;
    json["videos"] = videos.json();
    for (const auto& run : runs) json["runs"].push_back(run->json());
    json["camera"] = camera;
    return json;
}

/// What keeps a run from being compared with the first one.
void RunReport::Impl::note_differences(const Run& run) {
    if (runs.empty()) return;
    const StreamHeader& first = runs.front()->reader.header();
    const StreamHeader& header = run.reader.header();
    if (header.slot_us != first.slot_us)
        notes.push_back(fmt::format(
            "{}: its slots last {:g} us, those of {} {:g} us. The same slot is another time in "
            "them, and figures of a slot or a frame cannot be compared.",
            run.name, header.slot_us, runs.front()->name, first.slot_us));
    const std::string footage = footage_of(header.provenance);
    const std::string first_footage = footage_of(first.provenance);
    if (!footage.empty() && !first_footage.empty() && footage != first_footage)
        notes.push_back(fmt::format(
            "{}: by its provenance, it saw other footage than {}, or other light of it. {}",
            run.name, runs.front()->name,
            truth_slots > 0 ? "The truth cannot be that of both, so quality cannot be compared."
                            : "Their videos cannot be compared."));
}

RunReport::RunReport(RunReportOptions options, FrameShape shape, const FluxVideo* truth)
    : impl_(std::make_unique<Impl>(std::move(options), shape, truth)) {
    const PixelArea& area = impl_->area;
    if (area.rows < shape.rows || area.cols < shape.cols)
        impl_->notes.push_back(fmt::format(
            "The pictures show {} x {} of {} x {} pixels, from column {} and row {} on.", area.cols,
            area.rows, shape.cols, shape.rows, area.first_col, area.first_row));
    if (truth == nullptr) return;
    impl_->videos.add({"truth", "the light that the sensor saw", {}});
    for (int slot = 0; slot < truth->slots(); ++slot) put(0, slot, truth->frame(slot));
}

RunReport::~RunReport() = default;

std::size_t RunReport::add_run(const std::filesystem::path& stream, const std::string& name) {
    auto run = std::make_unique<Run>(stream, name, impl_->area);
    if (run->reader.header().schedule.weighted())
        throw InputError(stream.string(),
                         "a report shows no grey masks; \"stipple decode\" takes this stream");
    const FrameShape shape = decoded_shape(run->reader.header());
    if (shape != impl_->shape)
        throw InputError(stream.string(), shape_difference(shape, impl_->shape, "the report has"));
    impl_->note_differences(*run);
    run->read(impl_->options);
    impl_->slots = std::max(impl_->slots, run->loads.slots());
    if (const auto all = run->reader.slots(); all && *all > impl_->options.slots)
        impl_->notes.push_back(fmt::format("{}: the first {} of {} slots are shown.", name,
                                           impl_->options.slots, *all));
    if (!undamaged(run->reader.report()))
        impl_->notes.push_back(
            fmt::format("{}: the stream is damaged; its whole samples are shown.", name));
    impl_->runs.push_back(std::move(run));
    return impl_->runs.size() - 1;
}

std::size_t RunReport::add_video(VideoTitle title) {
    return impl_->featured = impl_->videos.add(std::move(title));
}

void RunReport::feature(std::size_t video) {
    impl_->featured = video;
}

void RunReport::put(std::size_t video, std::int64_t slot, std::span<const float> frame) {
    if (slot >= impl_->options.slots) return;
    impl_->videos.put(video, slot, frame);
    impl_->slots = std::max(impl_->slots, slot + 1);
    // So that memory is bounded too.
    while (impl_->videos.bytes() > impl_->options.max_bytes && impl_->videos.step() < impl_->slots)
        impl_->videos.halve();
}

void RunReport::set_camera(const std::string& json) {
    impl_->camera = parsed_camera(json);
}

void RunReport::fit() {
    if (impl_->truth_slots > 0 && impl_->truth_slots < impl_->slots)
        impl_->notes.push_back(fmt::format("The truth has {} of {} slots; quality is of these.",
                                           impl_->truth_slots, impl_->slots));
    std::size_t beside = report_page(impl_->options.title, impl_->data(), {}).size();
    for (const auto& run : impl_->runs) beside += run->samples.bytes();
    while (beside + impl_->videos.bytes() > impl_->options.max_bytes &&
           impl_->videos.step() < impl_->slots)
        impl_->videos.halve();
    if (beside + impl_->videos.bytes() > impl_->options.max_bytes)
        fail_size(impl_->options.max_bytes, "a picture of each video and all samples");
    const std::int64_t step = impl_->videos.step();
    if (step == 1) return;
    impl_->notes.push_back(fmt::format(
        "Pictures are of every {}{} slot only, to stay within {:.0f} MB; samples and quality are "
        "of all slots.",
        step, step == 2 ? "nd" : "th", 1e-6 * static_cast<double>(impl_->options.max_bytes)));
}

std::string RunReport::damage() const {
    std::string text;
    for (const auto& run : impl_->runs)
        if (const StreamReport& found = run->reader.report(); !undamaged(found))
            text += fmt::format("\n{}: {}", run->name, damage_text(found));
    return text;
}

const std::vector<std::string>& RunReport::notes() const {
    return impl_->notes;
}

std::string RunReport::json() const {
    // A name in a stream may have bytes that are no UTF-8.
    return impl_->data().dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

std::string RunReport::page() {
    const ordered_json data = impl_->data();
    auto planes = impl_->videos.take_planes();
    for (std::size_t r = 0; r < impl_->runs.size(); ++r)
        for (const PackedPlane& plane : impl_->runs[r]->samples.planes())
            planes.push_back({fmt::format("r{}{}", r, plane.id), plane.text});
    return report_page(impl_->options.title, data, planes);
}

std::string camera_page(const std::string& title, const std::string& command,
                        const std::string& json) {
    ordered_json data = empty_report(title, command);
    data["camera"] = parsed_camera(json);
    return report_page(title, data, {});
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
