#include "view/view_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "core/version.h"
#include "decoder/measurements.h"
#include "study/report/json_figures.h"
#include "study/report/report_page.h"
#include "study/report/stream_samples.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

constexpr std::int64_t kMaxWaitMs = 20'000;
/// The most slots of a question about one pixel.
constexpr std::int64_t kMaxPixelSlots = 256;

PageAnswer json_answer(const ordered_json& json) {
    return {"application/json", json.dump(-1, ' ', false, ordered_json::error_handler_t::replace)};
}

PageAnswer plane_answer(std::span<const std::uint16_t> values) {
    PageAnswer answer{"application/octet-stream", std::string(2 * values.size(), '\0')};
    if (!values.empty())  // of a little-endian CPU
        std::memcpy(answer.body.data(), values.data(), answer.body.size());
    return answer;
}

/// "r0k-12": kind of plane 'r', number 0, of samples 'k', slot 12.
struct PlaneId {
    char kind = 0;
    std::size_t number = 0;
    char of = 0;  ///< 0 of videos
    std::int64_t slot = 0;
};

std::optional<PlaneId> parsed(std::string_view id) {
    if (id.empty()) return {};
    PlaneId found{.kind = id[0]};
    const char* const end = id.data() + id.size();
    auto [at, error] = std::from_chars(id.data() + 1, end, found.number);
    if (error != std::errc{} || at == end) return {};
    if (*at != '-') found.of = *at++;
    if (at == end || *at != '-') return {};
    const auto slot = std::from_chars(at + 1, end, found.slot);
    if (slot.ec != std::errc{} || slot.ptr != end || found.slot < 0) return {};
    return found;
}

}  // namespace

ViewPage::ViewPage(const ViewOptions& options)
    : command_(options.command), camera_(options.camera) {
    if (camera_ != nullptr) add_camera(*camera_);
    for (const auto& source : options.sources)
        is_stream(source) ? add_stream(source, options) : add_footage(source, options);
    if (!options.truth.empty()) {
        truth_ = videos_.size();
        add_footage(options.truth, options);
        videos_.back().name = "truth";
    }
    if (camera_ == nullptr) title_ = options.sources.front().filename().string();
}

void ViewPage::require_shape(FrameShape shape, const std::filesystem::path& source) {
    if (videos_.empty()) shape_ = shape;
    if (shape != shape_)
        throw InputError(source.string(), shape_difference(shape, shape_, "the first source has"));
}

void ViewPage::add_stream(const std::filesystem::path& file, const ViewOptions& options) {
    StreamReader reader(file);
    if (const Message warning = calibrate(reader, options.calibration); !warning.empty()) {
        options.warn(warning);
        notes_.push_back(warning.text());
    }
    ViewedStream& stream = streams_.emplace_back(std::make_unique<FilePackets>(std::move(reader)),
                                                 file.stem().string());
    require_shape(decoded_shape(*stream.header()), file);
    timelines_.emplace_back(file);
    SlotDecoder& decoder =
        decoders_.emplace_back(stream, file, options.decoding, options.calibration);
    videos_.push_back(
        {stream.name(), fmt::format("{}, decoded", file.string()), streams_.size() - 1, &decoder});
}

void ViewPage::add_camera(CameraView& camera) {
    RecentSlots& recent = camera.recent();
    title_ = camera.name();
    shape_ = decoded_shape(*recent.header());
    videos_.push_back({"camera",
                       camera.address(),
                       {},
                       nullptr,
                       [&recent](std::int64_t slot) { return recent.codes(slot); },
                       [&recent](std::int64_t slot, int plane, int row, int col) {
                           return recent.code(slot, plane, row, col);
                       }});
    ViewedStream& stream =
        streams_.emplace_back(std::make_unique<RecentPackets>(recent), "emulated");
    videos_.push_back({"decoded", camera.address() + ", through the emulated chip", 0,
                       &decoders_.emplace_back(stream)});
}

void ViewPage::add_footage(const std::filesystem::path& source, const ViewOptions& options) {
    ViewedVideo& video = footage_.emplace_back(source, options.footage, options.warn);
    require_shape(video.shape(), source);
    videos_.push_back({video.name(),
                       source.string(),
                       {},
                       nullptr,
                       [&video](std::int64_t slot) { return video.codes(slot); },
                       [&video](std::int64_t slot, int plane, int row, int col) {
                           return video.code(slot, plane, row, col);
                       }});
}

void ViewPage::end() {
    ended_ = true;
    for (SlotDecoder& decoder : decoders_) decoder.end();
}

std::int64_t ViewPage::slots() {
    return extent().slots;
}

SlotExtent ViewPage::extent() {
    SlotExtent all{.slots = 1, .complete = true};
    for (ViewedStream& stream : streams_) {
        const SlotExtent extent = stream.extent();
        all.slots = std::max(all.slots, extent.slots);
        all.complete = all.complete && extent.complete;
        all.first = extent.first;  // only a camera, the one source, forgets
    }
    for (const ViewedVideo& video : footage_) all.slots = std::max(all.slots, video.slots());
    return all;
}

ordered_json ViewPage::data() {
    ordered_json json{{"program", fmt::format("stipple {}", version())},
                      {"title", title_},
                      {"command", command_},
                      {"notes", notes_},
                      {"truth", or_null(truth_)},
                      {"featured", 0},
                      {"slots", slots()},
                      {"picture_step", 1},
                      {"camera", nullptr},
                      {"running_camera", camera_ == nullptr ? ordered_json(nullptr)
                                                            : ordered_json(camera_->address())}};
    json.update(pictures_json(shape_, {.rows = shape_.rows, .cols = shape_.cols}));
    if (camera_ != nullptr) json["schedules"] = config_names(ConfigKind::kSchedules);
    json["videos"] = ordered_json::array();
    for (const Video& video : videos_)
        json["videos"].push_back({{"name", video.name},
                                  {"text", video.text},
                                  {"run", or_null(video.run)},
                                  {"quality", nullptr}});
    json["runs"] = ordered_json::array();
    for (ViewedStream& stream : streams_) json["runs"].push_back(stream.json());
    return json;
}

std::string ViewPage::html() {
    return view_page(title_, data());
}

/// How old the frame of a running camera is.
void ViewPage::add_age(PageAnswer& answer, std::int64_t slot) const {
    const std::int64_t arrival_ns = camera_ == nullptr ? 0 : camera_->recent().arrival_ns(slot);
    if (arrival_ns > 0)
        answer.fields["Stipple-Age-Ms"] =
            fmt::format("{:.1f}", static_cast<double>(monotonic_ns() - arrival_ns) * 1e-6);
}

std::optional<PageAnswer> ViewPage::picture(const Video& video, std::int64_t slot,
                                            const PageRequest& request) {
    if (video.codes) {
        PageAnswer answer = plane_answer(video.codes(slot));
        add_age(answer, slot);
        return answer;
    }
    using Level = SlotDecoder::Level;
    const auto than = std::clamp<std::int64_t>(request.number("than").value_or(0), 0, 3);
    const auto wait = std::clamp<std::int64_t>(request.number("wait").value_or(0), 0, kMaxWaitMs);
    const auto found =
        video.decoder->picture(request.text("viewer").substr(0, 64), slot, static_cast<Level>(than),
                               std::chrono::milliseconds(wait));
    if (!found) return plane_answer({});
    PageAnswer answer = plane_answer(*found->codes);
    add_age(answer, slot);
    answer.fields["Stipple-Level"] = std::to_string(static_cast<int>(found->level));
    answer.fields["Stipple-Method"] = video.decoder->name_of(found->level);
    return answer;
}

std::optional<PageAnswer> ViewPage::plane(const std::string& id, const PageRequest& request) {
    const auto wanted = parsed(id);
    if (!wanted) return {};
    const SlotExtent now = extent();
    if (wanted->slot < now.first || wanted->slot >= now.slots) {
        if (camera_ == nullptr) return {};
        return plane_answer({});  // forgotten meanwhile, or of the camera before it was opened anew
    }
    if (wanted->kind == 'v' && wanted->of == 0 && wanted->number < videos_.size())
        return picture(videos_[wanted->number], wanted->slot, request);
    if (wanted->kind != 'r' || wanted->number >= streams_.size()) return {};
    ViewedStream& stream = streams_[wanted->number];
    switch (wanted->of) {
        case 'k':
            return plane_answer(stream.samples(wanted->slot).kinds);
        case 'd':
            return plane_answer(stream.samples(wanted->slot).dn);
        case 'e':
            return plane_answer(stream.exposure_map(wanted->slot));
        default:
            return {};
    }
}

namespace {

/// A pixel, and the slots of it that are asked for.
struct PixelQuestion {
    int row;
    int col;
    int plane;
    std::int64_t first;
    std::int64_t end;
};

std::optional<PixelQuestion> pixel_question(const PageRequest& request, FrameShape shape,
                                            std::int64_t slots) {
    const auto number = [&](const char* key, std::int64_t end) -> std::optional<int> {
        const auto value = request.number(key);
        return value && *value >= 0 && *value < end ? std::optional(static_cast<int>(*value))
                                                    : std::nullopt;
    };
    const auto row = number("row", shape.rows), col = number("col", shape.cols);
    const auto plane = request.keys.contains("plane") ? number("plane", shape.planes) : 0;
    if (!row || !col || !plane) return {};
    const std::int64_t first =
        std::clamp<std::int64_t>(request.number("first").value_or(0), 0, slots);
    const std::int64_t end = std::clamp<std::int64_t>(request.number("end").value_or(slots), first,
                                                      std::min(slots, first + kMaxPixelSlots));
    return PixelQuestion{*row, *col, *plane, first, end};
}

}  // namespace

std::optional<std::size_t> ViewPage::run_of(const PageRequest& request) const {
    const auto run = request.number("run").value_or(-1);
    if (run < 0 || run >= static_cast<std::int64_t>(streams_.size())) return {};
    return static_cast<std::size_t>(run);
}

std::optional<PageAnswer> ViewPage::samples(const PageRequest& request) {
    const auto run = run_of(request);
    const auto pixel = pixel_question(request, shape_, slots());
    if (!pixel || !run) return {};
    return json_answer(
        streams_[*run].samples_of_pixel(pixel->row, pixel->col, pixel->first, pixel->end));
}

std::optional<PageAnswer> ViewPage::light(const PageRequest& request) {
    const auto number = request.number("video").value_or(-1);
    const auto pixel = pixel_question(request, shape_, slots());
    if (!pixel || number < 0 || number >= static_cast<std::int64_t>(videos_.size())) return {};
    const Video& video = videos_[static_cast<std::size_t>(number)];
    const auto code_in = [&](std::int64_t slot) -> std::optional<std::uint16_t> {
        if (video.code) return video.code(slot, pixel->plane, pixel->row, pixel->col);
        const auto codes = video.decoder->known(slot).codes;
        if (!codes) return {};
        return (*codes)[index(pixel->plane) * shape_.pixels() +
                        row_major(pixel->row, pixel->col, shape_.cols)];
    };
    ordered_json list = ordered_json::array();
    for (std::int64_t slot = pixel->first; slot < pixel->end; ++slot)
        if (const auto code = code_in(slot)) list.push_back({slot, *code});
    return json_answer(list);
}

PageAnswer ViewPage::status(const PageRequest& request) {
    const auto wait = std::clamp<std::int64_t>(request.number("wait").value_or(0), 0, kMaxWaitMs);
    const auto than = request.number("than").value_or(-1);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait);
    SlotExtent now = extent();
    while (now.slots <= than && !now.complete && !ended_ &&
           std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        now = extent();
    }
    ordered_json switched = ordered_json::array();
    for (ViewedStream& stream : streams_) {
        const auto header = stream.header();
        switched.push_back(header->switches.empty() ? 0 : header->switches.back().slot);
    }
    return json_answer({{"slots", now.slots},
                        {"first", now.first},
                        {"complete", now.complete},
                        {"switched", switched}});
}

std::optional<PageAnswer> ViewPage::ask_camera(const std::string& what) {
    if (what == "camera") return json_answer(camera_->status());
    if (what == "camera/features") return json_answer(camera_->features());
    return {};
}

std::optional<PageAnswer> ViewPage::act(const PageRequest& request) {
    if (camera_ == nullptr) return {};
    if (request.path == "camera/record")
        camera_->record();
    else if (request.path == "camera/stop")
        camera_->stop_recording();
    else if (request.path == "camera/sensor")
        camera_->change_sensor(request.text("changes"));
    else
        return {};
    return json_answer(camera_->status());
}

std::optional<PageAnswer> ViewPage::answer(const PageRequest& request) {
    constexpr std::string_view kPlane = "plane/";
    if (request.acts) return act(request);
    if (request.path.empty()) return PageAnswer{"text/html; charset=utf-8", html()};
    if (request.path.starts_with(kPlane)) return plane(request.path.substr(kPlane.size()), request);
    if (request.path == "samples") return samples(request);
    if (request.path == "light") return light(request);
    if (request.path == "run")
        if (const auto run = run_of(request)) return json_answer(streams_[*run].json());
    if (request.path == "timeline" && camera_ == nullptr)
        if (const auto run = run_of(request)) return json_answer(timelines_[*run].json());
    if (request.path == "readout") {
        const auto run = run_of(request);
        const auto slot = request.number("slot").value_or(-1);
        if (!run || slot < 0 || slot >= slots()) return {};
        return json_answer(readout_lanes_json(*streams_[*run].header(), slot));
    }
    if (request.path == "status") return status(request);
    if (camera_ != nullptr) return ask_camera(request.path);
    return {};
}

}  // namespace stipple
