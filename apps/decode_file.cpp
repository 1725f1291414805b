#include "apps/decode.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "apps/interrupt.h"
#include "apps/report/emulation_text.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/report/stage_outputs.h"
#include "apps/rig_folder.h"
#include "apps/standard_error.h"
#include "core/error.h"
#include "core/parallel.h"
#include "decoder/decode_cost.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/frame_writer.h"
#include "io/growing_file.h"
#include "stream/stream_figures.h"

namespace stipple {
namespace {

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

/// The streams of the folder of a rig; of any other input the one stream.
RigFolder open_streams(const DecodeArguments& arguments, GrowingFile& growing) {
    const ReadPolicy policy = arguments.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant;
    if (is_rig_folder(arguments.stream)) return open_rig_folder(arguments.stream, policy);
    RigFolder alone;
    alone.rig.sensors.resize(1);
    alone.readers.push_back(open_stream(arguments, policy, growing));
    return alone;
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

/// What made the frames end.
enum class DecodeEnd : std::uint8_t { kStream, kUntil, kTimeout, kSignal };

/// By DecodeEnd: values of the JSON key `ended_by`.
constexpr std::array<std::string_view, 4> kEndNames{"stream", "until", "timeout", "signal"};

/// NaN without a sample.
double saturated_fraction(const DecodeReport& report) {
    return static_cast<double>(report.saturated_samples) / static_cast<double>(report.samples);
}

double zero_fraction(const DecodeReport& report) {
    return static_cast<double>(report.zero_samples) / static_cast<double>(report.samples);
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

/// Tells what to expect of a run of more than a minute.
void say_cost(const DecodeCost& cost, const RunOptions& run) {
    if (cost.seconds < 60 || run.quiet) return;
    say_note("decoding takes about {} and {:.0f} MB of memory", rough_time(cost.seconds),
             1e-6 * static_cast<double>(cost.bytes));
}

/// A run of the command: opened by the constructor, then `run`, then `tell`.
class DecodeRun {
  public:
    DecodeRun(const DecodeArguments& arguments, const RunOptions& run);
    /// Decodes and completes the outputs. \throws InputError without a slot, Interrupted before the
    /// first one, and as `decode`, FrameWriter and StageOutputs.
    void run();
    /// Writes figures, result and warnings. \throws InputError if the stream is damaged.
    void tell();

  private:
    [[nodiscard]] std::optional<ScheduleCheck> check_schedule();
    [[nodiscard]] DecodeReport decode_frames();
    [[nodiscard]] DecodeEnd found_end() const;
    [[nodiscard]] double voxels_per_second() const;
    [[nodiscard]] nlohmann::ordered_json figures() const;
    [[nodiscard]] std::string summary() const;
    void warn_of_end() const;
    [[nodiscard]] const std::string& name_of(const StreamReader& reader) const;
    void warn_of_faults(const StreamReader& reader) const;
    void refuse_damage(const StreamReader& reader) const;

    const DecodeArguments& arguments_;
    const RunOptions& run_;
    DecodeOptions options_;
    GrowingFile growing_;
    JsonFile json_;
    std::optional<ScheduleCheck> check_;
    RigFolder input_;
    StreamReader& reader_;  ///< of the stream, or of the first one of a rig
    FrameWriter writer_;
    StageOutputs stages_;
    DecodeReport report_;
    DecodeEnd end_ = DecodeEnd::kStream;
};

DecodeRun::DecodeRun(const DecodeArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      options_(read_decode_setup(arguments).options),
      growing_(arguments.stream, arguments.timeout_s, [] { return stop_signal() != 0; }),
      json_(run),
      check_(check_schedule()),
      input_(open_streams(arguments, growing_)),
      reader_(input_.readers.front()),
      writer_(arguments.output, decoded_shape(reader_.header()),
              writer_options(arguments, run, reader_.header())),
      stages_(arguments.stages, decoded_shape(reader_.header()), run.force) {
    if (check_ && check_->verdict == ScheduleCheck::Verdict::kShifted)
        reader_.use_schedule(shifted_schedule(reader_.header().schedule, check_->shift));
    for (StreamReader& reader : input_.readers) {
        DecodeArguments own = arguments;
        if (input_.readers.size() > 1) own.stream = reader.name();
        calibrate(reader, own);
    }
    say_leftover(arguments.output);
    options_.stages = stages_.sink();
}

std::optional<ScheduleCheck> DecodeRun::check_schedule() {
    if (arguments_.check_schedule == CheckSchedule::kNo) return {};
    StreamReader reader = open_stream(arguments_, ReadPolicy::kAnySchedule, growing_);
    return checked_schedule(reader, arguments_, run_);
}

void DecodeRun::run() {
    report_ = decode_frames();
    if (report_.slots == 0)
        throw_if_stopped("nothing is written, for frames are completed 48 at a time");
    if (report_.slots == 0) throw InputError(arguments_.stream, "holds no slot to decode");
    writer_.finish();
    stages_.finish();
    end_ = found_end();
}

DecodeReport DecodeRun::decode_frames() {
    std::optional<std::int64_t> total = reader_.slots();
    const std::int64_t until = arguments_.until;
    if (until > 0) total = std::min(total.value_or(until), until);
    std::int64_t written = 0;
    const std::vector<RigStream> streams = input_.streams();
    Progress progress(run_, "decoding", total);
    if (const auto slots = reader_.slots()) {
        const std::int64_t computed = computed_slots(*total, *slots);
        progress.set_work(static_cast<double>(computed));
        say_cost(expected_cost(streams, options_.method, computed), run_);
    }
    return decode_rig(
        streams, options_,
        [&](std::int64_t slot, std::span<const float> frame) {
            writer_.write(frame);
            written = slot + 1;
            return written != until && stop_signal() == 0;
        },
        [&](double slots) {
            progress.reach(slots, written);
            return stop_signal() == 0;
        });
}

void DecodeRun::tell() {
    warn_of_end();
    say_warning(
        zero_warning(arguments_.stream, zero_fraction(report_), reader_.header().calibration));
    for (const StreamReader& reader : input_.readers) warn_of_faults(reader);
    json_.write(figures());
    run_.say(summary());
    if (const auto levels = writer_.light_levels()) run_.say(light_levels_text(*levels));
    for (const StreamReader& reader : input_.readers) refuse_damage(reader);
}

DecodeEnd DecodeRun::found_end() const {
    if (report_.slots == arguments_.until) return DecodeEnd::kUntil;
    if (stop_signal() != 0) return DecodeEnd::kSignal;
    return growing_.timed_out() ? DecodeEnd::kTimeout : DecodeEnd::kStream;
}

double DecodeRun::voxels_per_second() const {
    return static_cast<double>(report_.voxels) / report_.seconds;
}

nlohmann::ordered_json DecodeRun::figures() const {
    nlohmann::ordered_json json{{"method", arguments_.method},
                                {"seconds", report_.seconds},
                                {"slots", report_.slots},
                                {"ended_by", kEndNames[static_cast<std::size_t>(end_)]},
                                {"saturated_fraction", saturated_fraction(report_)},
                                {"zero_fraction", zero_fraction(report_)},
                                {"voxels", report_.voxels},
                                {"voxels_per_second", voxels_per_second()},
                                {"peak_memory_bytes", peak_memory_bytes()},
                                {"threads", thread_count()},
                                {"calibration", calibration_json(arguments_)}};
    if (input_.readers.size() > 1) json["sensors"] = input_.readers.size();
    if (check_) json["schedule_check"] = check_json(*check_);
    if (!stages_.figures().empty()) json["convergence"] = stages_.figures();
    if (const auto levels = writer_.light_levels())
        json["light_levels"] = light_levels_json(*levels);
    return json;
}

std::string DecodeRun::summary() const {
    return fmt::format(
        "{}: {}, method {}, {} s, {} million voxels/s, {} MB{}{}", arguments_.output,
        counted(report_.slots, "frame"), arguments_.method, rounded(report_.seconds),
        rounded(1e-6 * voxels_per_second()), peak_memory_bytes() / 1000000,
        report_.samples == 0
            ? ""
            : fmt::format(", {:.2f} % of the samples saturated, {:.2f} % at DN 0",
                          100 * saturated_fraction(report_), 100 * zero_fraction(report_)),
        calibrated_text(arguments_));
}

/// Ends that the user may not expect.
void DecodeRun::warn_of_end() const {
    if (end_ == DecodeEnd::kTimeout)
        say_warning(
            "{}: nothing was appended for {:g} s (--timeout), so it was decoded as "
            "if it ended here, after {}",
            arguments_.stream, growing_.timeout_s(), counted(report_.slots, "slot"));
    else if (end_ == DecodeEnd::kStream && arguments_.until > 0)
        say_warning("{}: ends after {}, before --until {}", arguments_.stream,
                    counted(report_.slots, "slot"), arguments_.until);
}

const std::string& DecodeRun::name_of(const StreamReader& reader) const {
    return arguments_.follow ? arguments_.stream : reader.name();
}

void DecodeRun::warn_of_faults(const StreamReader& reader) const {
    const StreamReport& found = reader.report();
    if (const auto text = no_sample_text(found); !text.empty())
        say_warning("{}: {}", name_of(reader), text);
    if (const auto text = no_end_text(found); end_ == DecodeEnd::kStream && !text.empty())
        say_warning("{}: {} (--follow)", name_of(reader), text);
}

void DecodeRun::refuse_damage(const StreamReader& reader) const {
    StreamReport found = reader.report();
    if (end_ == DecodeEnd::kSignal)
        found.tail_bytes = 0;  // of a packet that was still being written
    if (const auto text = decoded_damage_text(found, schedule_hint(found)); !text.empty())
        throw InputError(name_of(reader), text);
}

}  // namespace

void decode_file(const DecodeArguments& arguments, const RunOptions& run) {
    DecodeRun decoding(arguments, run);
    decoding.run();
    decoding.tell();
}

}  // namespace stipple
