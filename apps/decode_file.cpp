#include "apps/decode.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "apps/interrupt.h"
#include "apps/output/emulation_text.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/stage_outputs.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "core/named_value.h"
#include "core/parallel.h"
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
            StreamReader reader(*file, policy,
                                [&](std::uint64_t bytes) { return growing.more(bytes); });
            reader.use_name(arguments.stream);
            return reader;
        } catch (const InputError&) {
            throw_if_stopped();  // the rest of the header may still have come
            if (std::filesystem::exists(*file)) throw;
            // Its writer has completed it meanwhile, and given it its name.
        }
    }
}

DecodeSession open_session(const DecodeArguments& arguments, DecodeSetup setup,
                           GrowingFile& growing) {
    const ReadPolicy policy = arguments.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant;
    const CalibrationChoice calibration = calibration_choice(arguments.calibration);
    if (is_rig_folder(arguments.stream))
        return {open_rig_folder(arguments.stream, policy, [] { throw_if_stopped(); }),
                std::move(setup), calibration};
    return {open_stream(arguments, policy, growing), std::move(setup), calibration};
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

/// Values of the JSON key `ended_by`.
constexpr auto kDecodeEnds = std::to_array<NamedValue<DecodeEnd>>({{"stream", DecodeEnd::kStream},
                                                                   {"until", DecodeEnd::kUntil},
                                                                   {"timeout", DecodeEnd::kTimeout},
                                                                   {"signal", DecodeEnd::kSignal}});

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
    void warn_of_faults(const StreamReader& reader) const;
    void refuse_damage(const StreamReader& reader) const;

    const DecodeArguments& arguments_;
    const RunOptions& run_;
    DecodeSetup setup_;  ///< until the session has it
    GrowingFile growing_;
    JsonFile json_;
    std::optional<ScheduleCheck> check_;
    DecodeSession session_;
    FrameWriter writer_;
    StageOutputs stages_;
    DecodeReport report_;
    DecodeEnd end_ = DecodeEnd::kStream;
};

DecodeRun::DecodeRun(const DecodeArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      setup_(setup_of(arguments)),
      growing_(arguments.stream, arguments.timeout_s, [] { return stop_signal() != 0; }),
      json_(run),
      check_(check_schedule()),
      session_(open_session(arguments, std::move(setup_), growing_)),
      writer_(arguments.output, session_.shape(),
              writer_options(arguments, run, session_.streams().front().header())),
      stages_(arguments.stages, session_.shape(), run.force) {
    if (StreamReader& stream = session_.streams().front();
        check_ && check_->verdict == ScheduleCheck::Verdict::kShifted)
        stream.use_schedule(shifted_schedule(stream.header().schedule, check_->shift));
    for (const Message& warning : session_.warnings()) say_warning(warning);
    say_leftover(arguments.output);
    session_.keep_stages(stages_.sink());
    if (arguments.until > 0) session_.end_after(arguments.until);
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
    writer_.finish();
    stages_.finish();
    end_ = found_end();
}

DecodeReport DecodeRun::decode_frames() {
    Progress progress(run_, "decoding", session_.frames());
    if (const auto slots = session_.computed_slots()) {
        progress.set_work(static_cast<double>(*slots));
        say_cost(session_.expected_cost(*slots), run_);
    }
    std::int64_t written = 0;
    return session_.run(
        [&](std::int64_t slot, std::span<const float> frame) {
            writer_.write(frame);
            written = slot + 1;
            return stop_signal() == 0;
        },
        [&](double slots) {
            progress.reach(slots, written);
            return stop_signal() == 0;
        });
}

void DecodeRun::tell() {
    warn_of_end();
    say_warning(zero_warning(arguments_.stream, zero_fraction(report_),
                             session_.streams().front().header().calibration));
    for (const StreamReader& stream : session_.streams()) warn_of_faults(stream);
    json_.write(figures());
    run_.say(summary());
    if (const auto levels = writer_.light_levels()) run_.say(light_levels_text(*levels));
    for (const StreamReader& stream : session_.streams()) refuse_damage(stream);
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
                                {"ended_by", name_in(kDecodeEnds, end_)},
                                {"saturated_fraction", saturated_fraction(report_)},
                                {"zero_fraction", zero_fraction(report_)},
                                {"voxels", report_.voxels},
                                {"voxels_per_second", voxels_per_second()},
                                {"peak_memory_bytes", peak_memory_bytes()},
                                {"threads", thread_count()},
                                {"calibration", calibration_json(arguments_)}};
    if (session_.streams().size() > 1) json["sensors"] = session_.streams().size();
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

void DecodeRun::warn_of_faults(const StreamReader& reader) const {
    const StreamReport& found = reader.report();
    if (const auto text = no_sample_text(found); !text.empty())
        say_warning("{}: {}", reader.name(), text);
    if (const auto text = no_end_text(found); end_ == DecodeEnd::kStream && !text.empty())
        say_warning("{}: {} (--follow)", reader.name(), text);
}

void DecodeRun::refuse_damage(const StreamReader& reader) const {
    StreamReport found = reader.report();
    if (end_ == DecodeEnd::kSignal)
        found.tail_bytes = 0;  // of a packet that was still being written
    if (const auto text = decoded_damage_text(found, schedule_hint(found)); !text.empty())
        throw InputError(reader.name(), text);
}

}  // namespace

void decode_file(const DecodeArguments& arguments, const RunOptions& run) {
    DecodeRun decoding(arguments, run);
    decoding.run();
    decoding.tell();
}

}  // namespace stipple
