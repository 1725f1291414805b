#include "apps/decode_file.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "apps/decode_schedule.h"
#include "apps/fixed_pattern.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/stage_outputs.h"
#include "apps/standard_error.h"
#include "core/config.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/frame_writer.h"
#include "io/growing_file.h"
#include "stream/stream_figures.h"

namespace stipple {
namespace {

DecodeOptions options_of(const DecodeArguments& arguments) {
    const DecodeMethod method = decode_method_from_name(arguments.method);
    if (!arguments.stages.empty() && method != DecodeMethod::kPortz2013)
        throw InputError("--stages",
                         fmt::format("method {} has none; portz2013 has", arguments.method));
    Config config = arguments.options.empty()
                        ? Config(arguments.settings, "decoder")
                        : Config(arguments.options, arguments.settings, "decoder");
    return read_decode_options(method, config);
}

/// The most memory of this process that has lain in RAM at a time.
std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // kilobytes on Linux
}

StreamReader open_stream(const DecodeArguments& arguments, ReadPolicy policy,
                         GrowingFile& growing) {
    if (!arguments.follow) return StreamReader(arguments.stream, policy);
    for (;;) {
        const auto file = growing.wait_for_file();
        if (!file) throw Interrupted{};
        try {
            return StreamReader(*file, policy,
                                [&](std::uint64_t bytes) { return growing.more(bytes); });
        } catch (const InputError&) {
            throw_if_stopped();  // the rest of the header may still have come
            if (std::filesystem::exists(*file)) throw;
            // Its writer has completed it meanwhile, and given it its name.
        }
    }
}

/// Uses the calibration of the chip, or says what it costs that there is none.
void calibrate(StreamReader& reader, const DecodeArguments& arguments) {
    if (arguments.calibration.empty())
        say_warning(fixed_pattern_warning(arguments.stream, reader.header()));
    else
        reader.use_sites(read_sites(arguments.calibration, reader.header()));
}

FrameWriterOptions writer_options(const DecodeArguments& arguments, const RunOptions& run,
                                  const StreamHeader& header) {
    FrameWriterOptions options{.video = arguments.video,
                               .images = arguments.images,
                               .force = run.force,
                               .live = arguments.follow && !arguments.strict};
    options.images.slot_s = header.slot_us * 1e-6;
    return options;
}

DecodeReport decode_frames(StreamReader& reader, const DecodeOptions& options, FrameWriter& writer,
                           const DecodeArguments& arguments, const RunOptions& run) {
    std::optional<std::int64_t> total = reader.slots();
    if (arguments.until > 0) total = std::min(total.value_or(arguments.until), arguments.until);
    Progress progress(run, "decoding", total);
    std::int64_t written = 0;
    return decode(
        reader, options,
        [&](std::int64_t slot, std::span<const float> frame) {
            writer.write(frame);
            written = slot + 1;
            return written != arguments.until && stop_signal() == 0;
        },
        [&](double slots) {
            progress.reach(slots, written);
            return stop_signal() == 0;
        });
}

/// What made the frames end.
enum class DecodeEnd : std::uint8_t { kStream, kUntil, kTimeout, kSignal };

/// By DecodeEnd: values of the JSON key `ended_by`.
constexpr std::array<std::string_view, 4> kEndNames{"stream", "until", "timeout", "signal"};

DecodeEnd end_of(const DecodeReport& report, const DecodeArguments& arguments,
                 const GrowingFile& growing) {
    if (report.slots == arguments.until) return DecodeEnd::kUntil;
    if (stop_signal() != 0) return DecodeEnd::kSignal;
    return growing.timed_out() ? DecodeEnd::kTimeout : DecodeEnd::kStream;
}

/// Ends that the user may not expect.
void warn(DecodeEnd end, const DecodeReport& report, const DecodeArguments& arguments,
          const GrowingFile& growing) {
    if (end == DecodeEnd::kTimeout)
        say_error(
            "{}: nothing was appended for {:g} s (--timeout), so it was decoded as "
            "if it ended here, after {}",
            arguments.stream, growing.timeout_s(), counted(report.slots, "slot"));
    else if (end == DecodeEnd::kStream && arguments.until > 0)
        say_error("{}: ends after {}, before --until {}", arguments.stream,
                  counted(report.slots, "slot"), arguments.until);
}

/// NaN without a sample.
double saturated_fraction(const DecodeReport& report) {
    return static_cast<double>(report.saturated_samples) / static_cast<double>(report.samples);
}

nlohmann::ordered_json figures_of(const DecodeReport& report, const std::string& method,
                                  DecodeEnd end) {
    return {{"method", method},
            {"seconds", report.seconds},
            {"slots", report.slots},
            {"ended_by", kEndNames[static_cast<std::size_t>(end)]},
            {"saturated_fraction", saturated_fraction(report)},
            {"voxels", report.voxels},
            {"voxels_per_second", static_cast<double>(report.voxels) / report.seconds},
            {"peak_memory_bytes", peak_memory_bytes()},
            {"threads", thread_count()}};
}

nlohmann::ordered_json light_levels_json(const LightLevels& levels) {
    return {{"max_cll", levels.max_cll},
            {"max_fall", levels.max_fall},
            {"clipped_fraction", levels.clipped_fraction}};
}

std::string light_levels_text(const LightLevels& levels) {
    return fmt::format("PQ: MaxCLL {:.0f}, MaxFALL {:.0f} cd/m2, {:.2g} % of the values clipped",
                       levels.max_cll, levels.max_fall, 100 * levels.clipped_fraction);
}

/// What packets of a wrong size may mean.
std::string_view schedule_hint(const StreamReport& report) {
    return report.undue_packets == 0
               ? ""
               : "\n  the chip may have run another schedule: --check-schedule looks for it";
}

}  // namespace

void decode_file(const DecodeArguments& arguments, const RunOptions& run) {
    DecodeOptions options = options_of(arguments);
    options.fill_gaps = arguments.fill_gaps;
    options.where = arguments.stream;
    if (!arguments.follow) options.input_bytes = input_bytes(arguments.stream);
    GrowingFile growing(arguments.stream, arguments.timeout_s, [] { return stop_signal() != 0; });
    JsonFile json(run);
    std::optional<ScheduleCheck> check;
    if (arguments.check_schedule != CheckSchedule::kNo) {
        StreamReader reader = open_stream(arguments, ReadPolicy::kAnySchedule, growing);
        check = checked_schedule(reader, arguments, run);
    }
    StreamReader reader = open_stream(
        arguments, arguments.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant, growing);
    if (check && check->verdict == ScheduleCheck::Verdict::kShifted)
        reader.use_schedule(shifted_schedule(reader.header().schedule, check->shift));
    calibrate(reader, arguments);
    FrameWriter writer(arguments.output, decoded_shape(reader.header()),
                       writer_options(arguments, run, reader.header()));
    say_leftover(arguments.output);
    StageOutputs stages(arguments.stages, decoded_shape(reader.header()), run.force);
    options.stages = stages.sink();
    const DecodeReport report = decode_frames(reader, options, writer, arguments, run);
    if (report.slots == 0)
        throw_if_stopped("nothing is written, for frames are completed 48 at a time");
    if (report.slots == 0) throw InputError(arguments.stream, "holds no slot to decode");
    writer.finish();
    stages.finish();
    const DecodeEnd end = end_of(report, arguments, growing);
    auto figures = figures_of(report, arguments.method, end);
    if (check) figures["schedule_check"] = check_json(*check);
    if (!stages.figures().empty()) figures["convergence"] = stages.figures();
    const auto levels = writer.light_levels();
    if (levels) figures["light_levels"] = light_levels_json(*levels);
    json.write(figures);
    warn(end, report, arguments, growing);
    run.say(fmt::format("{}: {}, method {}, {} s, {} million voxels/s, {} MB{}", arguments.output,
                        counted(report.slots, "frame"), arguments.method, rounded(report.seconds),
                        rounded(1e-6 * figures["voxels_per_second"].get<double>()),
                        peak_memory_bytes() / 1000000,
                        report.samples == 0 ? ""
                                            : fmt::format(", {:.2f} % of the samples saturated",
                                                          100 * saturated_fraction(report))));
    if (levels) run.say(light_levels_text(*levels));
    StreamReport found = reader.report();
    if (found.samples == 0)
        say_warning(fmt::format("{}: holds no sample, so the frames are black", arguments.stream));
    if (end == DecodeEnd::kStream && !found.complete && undamaged(found))
        say_error("{}: has no end marker: it was cut off, or is still being written (--follow)",
                  arguments.stream);
    if (end == DecodeEnd::kSignal)
        found.tail_bytes = 0;  // of a packet that was still being written
    if (!undamaged(found))
        throw InputError(arguments.stream, fmt::format("{}{}\n  the output is made of what is left",
                                                       damage_text(found), schedule_hint(found)));
}

}  // namespace stipple
