#include "study/report/stream_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.h"
#include "core/flux_video.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/pending_output.h"
#include "io/text_file.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

bool exposes_alike(const fs::path& stream) {
    const StreamReader reader(stream);
    const ExposureSchedule& schedule = reader.header().schedule;
    return schedule.tile_rows() == 1 && schedule.tile_cols() == 1;
}

/// The streams in a folder, by name, those of conventional cameras last.
std::vector<fs::path> streams_in(const fs::path& folder) {
    std::vector<fs::path> streams;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".stipple" && entry.is_regular_file() &&
            !entry.path().filename().string().starts_with('.'))
            streams.push_back(entry.path());
    if (streams.empty()) throw InputError(folder.string(), "holds no sample stream (.stipple)");
    std::ranges::sort(streams);
    std::stable_partition(streams.begin(), streams.end(),
                          [](const fs::path& s) { return !exposes_alike(s); });
    return streams;
}

std::vector<fs::path> streams_of(const std::vector<std::string>& runs) {
    std::vector<fs::path> streams;
    for (const std::string& run : runs) {
        if (!fs::is_directory(run)) {
            if (fs::exists(run) && !fs::is_regular_file(run))
                throw InputError(run,
                                 "cannot be read several times, as a report needs; record to a "
                                 "file first");
            streams.emplace_back(run);
            continue;
        }
        const auto inside = streams_in(run);
        streams.insert(streams.end(), inside.begin(), inside.end());
    }
    return streams;
}

/// The first frames of the truth. \throws InputError if they have another shape.
FluxVideo read_truth(const ReportTruth& footage, std::int64_t max_slots, FrameShape shape,
                     const ReportCalls& calls) {
    if (footage.shape != shape)
        throw InputError(footage.name, shape_difference(footage.shape, shape, "the runs have"));
    constexpr std::uint64_t kValueBytes = 2 * sizeof(float);  // here, and in the video
    std::vector<float> light;
    std::int64_t slots = 0;
    for (auto frame = footage.next(); !frame.empty() && slots < max_slots; frame = footage.next()) {
        calls.check();
        check_memory(kValueBytes * (light.size() + frame.size()), footage.name,
                     "the truth of a report", footage.bytes);
        light.insert(light.end(), frame.begin(), frame.end());
        ++slots;
    }
    FluxVideo truth(static_cast<int>(slots), shape);
    std::ranges::copy(light, truth.data().begin());
    return truth;
}

std::string name_of(const ReportMethod& method) {
    if (const auto* own = std::get_if<OwnDecoder>(&method)) return own->name;
    return std::string(named(std::get<DecodeMethod>(method)).name);
}

/// A stream in the report.
struct ShownStream {
    fs::path file;
    std::string name;    ///< without extension; with its folder where two files have the same
    std::size_t number;  ///< RunReport::add_run
};

/// All of them before the first is decoded, so that one that does not fit ends the run at once.
std::vector<ShownStream> add_streams(RunReport& report, const std::vector<fs::path>& files,
                                     const ReportCalls& calls) {
    std::vector<ShownStream> streams;
    streams.reserve(files.size());
    for (const fs::path& file : files) {
        const auto same = std::ranges::count_if(
            files, [&](const fs::path& other) { return other.stem() == file.stem(); });
        const std::string name =
            (same == 1 ? file.stem() : file.parent_path() / file.stem()).string();
        calls.check();
        streams.push_back({file, name, report.add_run(file, name)});
    }
    return streams;
}

/// Decodes the first slots of a stream. `put` takes slot and frame.
template <typename Put>
void decode_slots(const fs::path& stream, const ReportMethod& method, std::int64_t slots,
                  const ReportCalls& calls, const Put& put) {
    StreamReader reader(stream);
    const ProgressCallback progress =
        calls.begin(fmt::format("{}, {}", stream.filename().string(), name_of(method)),
                    std::min(reader.slots().value_or(slots), slots));
    if (const auto* own = std::get_if<OwnDecoder>(&method)) {
        const FluxVideo video = own->decode(stream, "");
        check_video(*own, video, static_cast<int>(reader.slots().value_or(video.slots())),
                    decoded_shape(reader.header()));
        for (int slot = 0; slot < std::min<std::int64_t>(slots, video.slots()); ++slot)
            put(slot, video.frame(slot));
    } else {
        bool go_on = true;
        decode(
            reader, {.method = std::get<DecodeMethod>(method)},
            [&](std::int64_t slot, std::span<const float> frame) {
                put(slot, frame);
                return slot + 1 < slots && go_on;
            },
            [&](double done) { return go_on = progress(done); });
    }
    calls.check();
}

/// A stream by the naive method, which shows what the samples are, and by the chosen ones. Returns
/// the video of the first of these.
std::size_t add_videos(RunReport& report, const ShownStream& stream, const StreamReportTask& task,
                       const ReportCalls& calls) {
    std::vector<ReportMethod> methods{DecodeMethod::kNaive};
    std::ranges::copy_if(task.methods, std::back_inserter(methods), [](const ReportMethod& method) {
        return name_of(method) != named(DecodeMethod::kNaive).name;
    });
    std::size_t first = 0;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        const std::string by = name_of(methods[i]);
        const std::size_t video =
            report.add_video({fmt::format("{}, {}", stream.name, by),
                              fmt::format("{} decoded by {}", stream.name, by), stream.number});
        decode_slots(stream.file, methods[i], task.page.slots, calls,
                     [&](std::int64_t slot, auto frame) { report.put(video, slot, frame); });
        if (i <= 1) first = video;
    }
    return first;
}

RunReportOptions page_options(RunReportOptions options, const std::vector<fs::path>& streams,
                              const std::optional<FluxVideo>& truth) {
    if (!options.quality.max_value) {
        double brightest = 0;
        for (const fs::path& stream : streams)
            brightest = std::max(brightest, brightest_light(StreamReader(stream).header()));
        if (brightest > 0) options.quality.max_value = brightest;
    }
    if (truth) options.quality.margin = usual_margin(truth->slots());
    return options;
}

}  // namespace

StreamReportResult report_streams(StreamReportTask task, const ReportCalls& calls) {
    PendingOutput output(task.output, task.force);
    for (const ReportMethod& method : task.methods)
        if (const auto* own = std::get_if<OwnDecoder>(&method)) check_decoder(*own);
    const auto streams = streams_of(task.runs);
    const FrameShape shape = decoded_shape(StreamReader(streams.front()).header());
    std::optional<FluxVideo> truth;
    if (task.truth) truth = read_truth(*task.truth, task.page.slots, shape, calls);
    RunReport report(page_options(task.page, streams, truth), shape, truth ? &*truth : nullptr);
    if (!task.camera.empty()) report.set_camera(task.camera);
    std::vector<std::size_t> decoded;
    decoded.reserve(streams.size());
    for (const ShownStream& stream : add_streams(report, streams, calls))
        decoded.push_back(add_videos(report, stream, task, calls));
    report.feature(decoded.front());
    report.fit();
    const auto data = nlohmann::ordered_json::parse(report.json());
    const std::string page = report.page();
    write_text(output, page);
    nlohmann::ordered_json figures{{"file", task.output.string()}, {"bytes", page.size()}};
    for (const char* key : {"slots", "picture_step", "area", "quality_options", "videos"})
        figures[key] = data[key];
    figures["notes"] = report.notes();
    return {
        .figures = figures.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace),
        .bytes = page.size(),
        .runs = streams.size(),
        .videos = data["videos"].size(),
        .notes = report.notes(),
        .damage = report.damage()};
}

}  // namespace stipple
