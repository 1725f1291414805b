#include "apps/decode.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "core/parallel.h"
#include "session/video_shards.h"
#include "stream/stream_figures.h"

namespace stipple {
namespace {

constexpr auto kGoOn = "complete windows are kept, and the same command goes on";

ShardedDecoding decoding_of(const DecodeArguments& arguments) {
    DecodeSetup setup = setup_of(arguments);
    if (!std::filesystem::is_regular_file(arguments.stream))
        throw InputError(arguments.stream, "--part needs a file, which is read more than once");
    return {.stream = arguments.stream,
            .setup = std::move(setup),
            .calibration = calibration_choice(arguments.calibration),
            .policy = arguments.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant,
            .warn = [](const Message& warning) { say_warning(warning); }};
}

/// A run of the command: opened by the constructor, then `run`, then `tell`.
class PartRun {
  public:
    PartRun(const DecodeArguments& arguments, const RunOptions& run);
    /// Decodes the windows that are missing. \throws Interrupted, InputError, DeviceError.
    void run();
    /// Writes figures and result. \throws InputError if the stream is damaged.
    void tell();

  private:
    void decode_missing(const NumberRange& windows, Progress& progress);
    [[nodiscard]] std::int64_t slots_of_range(const NumberRange& windows) const;
    [[nodiscard]] double voxels_per_second() const;

    const DecodeArguments& arguments_;
    const RunOptions& run_;
    ShardedDecoding decoding_;
    JsonFile json_;
    VideoShards folder_;
    NumberRange windows_;
    std::vector<std::int64_t> missing_;
    std::int64_t slots_ = 0;  ///< decoded in this run
    double seconds_ = 0;
    StreamReport read_;
};

PartRun::PartRun(const DecodeArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      decoding_(decoding_of(arguments)),
      json_(run),
      folder_(arguments.output, identity_of(decoding_, [] { throw_if_stopped(); })),
      windows_(range_of(arguments.part, folder_.count())) {
    if (!run.force)
        missing_ = folder_.windows().missing(windows_);
    else
        for (std::int64_t number = windows_.begin; number < windows_.end; ++number)
            missing_.push_back(number);
}

void PartRun::run() {
    const std::vector<NumberRange> ranges = ranges_of(missing_);
    std::int64_t total = 0;
    for (const NumberRange& range : ranges) total += slots_of_range(range);
    const auto start = std::chrono::steady_clock::now();
    Progress progress(run_, "decoding", total);
    for (const NumberRange& range : ranges) decode_missing(range, progress);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::int64_t PartRun::slots_of_range(const NumberRange& windows) const {
    return folder_.end_slot(windows.end - 1) - folder_.begin_slot(windows.begin);
}

void PartRun::decode_missing(const NumberRange& windows, Progress& progress) {
    const std::int64_t before = slots_;
    const auto report =
        decode_windows(folder_, decoding_, windows, [&](double slots, std::int64_t frames) {
            slots_ = before + frames;
            progress.reach(static_cast<double>(before) + slots, slots_);
            return stop_signal() == 0;
        });
    if (!report) throw_if_stopped(kGoOn);
    read_ = report.value();
}

double PartRun::voxels_per_second() const {
    const auto sites = static_cast<double>(folder_.identity().shape.sites());
    return slots_ == 0 ? 0 : static_cast<double>(slots_) * sites / seconds_;
}

void PartRun::tell() {
    const std::int64_t windows = windows_.end - windows_.begin;
    const auto decoded = static_cast<std::int64_t>(missing_.size());
    json_.write({{"method", arguments_.method},
                 {"seconds", seconds_},
                 {"part", arguments_.part.number},
                 {"parts", arguments_.part.count},
                 {"windows", windows},
                 {"windows_decoded", decoded},
                 {"slots", slots_},
                 {"voxels", static_cast<std::uint64_t>(slots_) * folder_.identity().shape.sites()},
                 {"voxels_per_second", voxels_per_second()},
                 {"peak_memory_bytes", peak_memory_bytes()},
                 {"threads", thread_count()},
                 {"calibration", calibration_json(arguments_)}});
    run_.say(fmt::format("{}: part {} of {}, {} of {} decoded, {} kept, method {}, {} s{}",
                         arguments_.output, arguments_.part.number, arguments_.part.count, decoded,
                         counted(windows, "window"), windows - decoded, arguments_.method,
                         rounded(seconds_), calibrated_text(arguments_)));
    if (windows == 0)
        run_.say(fmt::format("the stream has {}, so this part has none",
                             counted(folder_.count(), "window")));
    read_.tail_bytes = 0;  // it may read beyond the part, not to the end
    if (const auto text = decoded_damage_text(read_, schedule_hint(read_)); !text.empty())
        throw InputError(arguments_.stream, text);
}

}  // namespace

void decode_part(const DecodeArguments& arguments, const RunOptions& run) {
    PartRun decoding(arguments, run);
    decoding.run();
    decoding.tell();
}

}  // namespace stipple
