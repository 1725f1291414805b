#include "apps/decode.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/window_folder.h"
#include "core/error.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"
#include "io/npy_writer.h"
#include "io/pending_output.h"
#include "readout/footage_origin.h"
#include "stream/stream_figures.h"
#include "stream/stream_identity.h"

namespace stipple {
namespace {

constexpr auto kGoOn = "complete windows are kept, and the same command goes on";

std::string sha256_of(const std::string& file) {
    return origin_of(file, {}, [] { throw_if_stopped(); }).sha256;
}

/// The slots of a stream, by its index or else by its packets.
std::int64_t slots_of(const std::string& file) {
    StreamReader reader(file, ReadPolicy::kCounts);
    if (!reader.slots())
        for (SamplePacket packet; reader.next(packet);) throw_if_stopped();
    const std::int64_t slots = reader.slots().value_or(reader.report().slots);
    if (slots == 0) throw InputError(file, "holds no slot to decode");
    return slots;
}

WindowIdentity identity_of(const DecodeArguments& arguments, const DecodeSetup& setup) {
    if (!std::filesystem::is_regular_file(arguments.stream))
        throw InputError(arguments.stream, "--part needs a file, which is read more than once");
    const StreamHeader header = StreamReader(arguments.stream).header();
    const std::string calibration = calibration_file(arguments);
    const std::string& dictionary = setup.options.hitomi2011.dictionary_file;
    const auto whole = stream_identity(arguments.stream);
    return {.stream_bytes = std::filesystem::file_size(arguments.stream),
            .stream = whole ? *whole : "sha256 " + sha256_of(arguments.stream),
            .method = arguments.method,
            .options = setup.given + (dictionary.empty() ? "" : "# " + sha256_of(dictionary)),
            .calibration_sha256 = calibration.empty() ? "" : sha256_of(calibration),
            .fill_gaps = arguments.fill_gaps,
            .slots = slots_of(arguments.stream),
            .shape = decoded_shape(header),
            .slot_us = header.slot_us};
}

struct WindowWriter {
    PendingOutput output;
    NpyWriter npy;

    WindowWriter(const WindowFolder& folder, std::int64_t number)
        : output(folder.window(number), true, OutputKind::kManagedFile),
          npy(output.partial(), output.final_path().string(), folder.identity().shape,
              folder.mark(number)) {}
};

/// A run of the command: opened by the constructor, then `run`, then `tell`.
class PartRun {
  public:
    PartRun(const DecodeArguments& arguments, const RunOptions& run);
    /// Decodes the windows that are missing. \throws Interrupted, InputError, DeviceError.
    void run();
    /// Writes figures and result. \throws InputError if the stream is damaged.
    void tell();

  private:
    void decode_windows(const NumberRange& windows, Progress& progress);
    [[nodiscard]] std::int64_t slots_of_range(const NumberRange& windows) const;
    [[nodiscard]] double voxels_per_second() const;

    const DecodeArguments& arguments_;
    const RunOptions& run_;
    DecodeSetup setup_;
    JsonFile json_;
    WindowFolder folder_;
    NumberRange windows_;
    std::vector<std::int64_t> missing_;
    std::int64_t slots_ = 0;  ///< decoded in this run
    double seconds_ = 0;
    StreamReport read_;
};

PartRun::PartRun(const DecodeArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      setup_(read_decode_setup(arguments)),
      json_(run),
      folder_(arguments.output, identity_of(arguments, setup_)),
      windows_(range_of(arguments.part, folder_.count())) {
    if (!run.force)
        missing_ = folder_.windows().missing(windows_.begin, windows_.end);
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
    for (const NumberRange& range : ranges) decode_windows(range, progress);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::int64_t PartRun::slots_of_range(const NumberRange& windows) const {
    return folder_.end_slot(windows.end - 1) - folder_.begin_slot(windows.begin);
}

void PartRun::decode_windows(const NumberRange& windows, Progress& progress) {
    StreamReader reader(arguments_.stream,
                        arguments_.strict ? ReadPolicy::kStrict : ReadPolicy::kTolerant);
    calibrate(reader, arguments_);
    DecodeOptions options = setup_.options;
    options.first_slot = folder_.begin_slot(windows.begin);
    const std::int64_t before = slots_;
    std::int64_t number = windows.begin;
    std::optional<WindowWriter> window;
    const auto take = [&](std::int64_t slot, std::span<const float> frame) {
        if (!window) {
            folder_.claim();  // only now: the method has accepted the stream
            remove_leftovers(folder_.window(number));
            window.emplace(folder_, number);
        }
        window->npy.write(frame);
        ++slots_;
        if (slot + 1 < folder_.end_slot(number)) return true;
        window->npy.finish();
        window->output.commit();
        window.reset();
        return ++number < windows.end && stop_signal() == 0;
    };
    const auto reached = [&](double slots) {
        progress.reach(
            static_cast<double>(before) + slots - static_cast<double>(options.first_slot), slots_);
        return stop_signal() == 0;
    };
    decode(reader, options, take, reached);
    read_ = reader.report();
    if (number == windows.end) return;
    throw_if_stopped(kGoOn);
    throw InputError(arguments_.stream, "has changed while it was decoded");
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
