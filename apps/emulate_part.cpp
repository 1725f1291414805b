#include "apps/emulate.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "readout/emulator.h"
#include "session/stream_shards.h"

namespace stipple {
namespace {

constexpr auto kGoOn = "complete pieces are kept, and the same command goes on";

/// \throws InputError unless the footage can be read more than once.
ShardedEmulation emulation_of(const EmulateArguments& arguments) {
    const std::string& footage = arguments.source.footage;
    std::error_code error;
    const auto type = std::filesystem::status(footage, error).type();
    if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character)
        throw InputError(footage, "--part needs files, which are read more than once");
    const EmulationInput input(arguments);
    const SensorSetup& setup = input.setup();
    return {.source = arguments.source,
            .setup = setup,
            .lead_in = lead_in_slots(setup),  // before the footage is read for its origin
            .header = stream_header_of(
                setup, provenance_of(setup, arguments.source.origin([] { throw_if_stopped(); }))),
            .warn = [](const Message& warning) { say_warning(warning); }};
}

/// A run of the command: opened by the constructor, then `run`, then `tell`.
class PartRun {
  public:
    PartRun(const EmulateArguments& arguments, const RunOptions& run);
    /// Emulates the pieces that are missing. \throws Interrupted, InputError, DeviceError.
    void run();
    void tell();

  private:
    void emulate_missing(const NumberRange& pieces, Progress& progress);
    [[nodiscard]] std::int64_t slots_of_range(const NumberRange& pieces) const;

    const EmulateArguments& arguments_;
    const RunOptions& run_;
    ShardedEmulation emulation_;
    JsonFile json_;
    StreamShards folder_;
    NumberRange pieces_;
    std::vector<std::int64_t> missing_;
    std::int64_t slots_ = 0;  ///< written in this run
    std::uint64_t samples_ = 0;
    double seconds_ = 0;
};

PartRun::PartRun(const EmulateArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      emulation_(emulation_of(arguments)),
      json_(run),
      folder_(arguments.output, emulation_.header,
              [&] { return count_slots(emulation_, [] { throw_if_stopped(); }); }),
      pieces_(range_of(arguments.part, folder_.pieces().count)) {
    if (!run.force)
        missing_ = folder_.pieces().missing(pieces_);
    else
        for (std::int64_t number = pieces_.begin; number < pieces_.end; ++number)
            missing_.push_back(number);
}

std::int64_t PartRun::slots_of_range(const NumberRange& pieces) const {
    return folder_.end_slot(pieces.end - 1) - folder_.begin_slot(pieces.begin);
}

void PartRun::run() {
    const std::vector<NumberRange> ranges = ranges_of(missing_);
    std::int64_t total = 0;
    for (const NumberRange& range : ranges) total += slots_of_range(range);
    const auto start = std::chrono::steady_clock::now();
    Progress progress(run_, "emulating", total);
    for (const NumberRange& range : ranges) emulate_missing(range, progress);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void PartRun::emulate_missing(const NumberRange& pieces, Progress& progress) {
    const std::int64_t before = slots_;
    const auto samples = emulate_pieces(folder_, emulation_, pieces, [&](std::int64_t slots) {
        progress.reach(static_cast<double>(before + slots));
        return stop_signal() == 0;
    });
    if (!samples) throw_if_stopped(kGoOn);
    samples_ += samples.value();
    slots_ += slots_of_range(pieces);
}

void PartRun::tell() {
    const std::int64_t pieces = pieces_.end - pieces_.begin;
    const auto emulated = static_cast<std::int64_t>(missing_.size());
    const double slots_per_second = slots_ == 0 ? 0 : static_cast<double>(slots_) / seconds_;
    json_.write({{"part", arguments_.part.number},
                 {"parts", arguments_.part.count},
                 {"pieces", pieces},
                 {"pieces_emulated", emulated},
                 {"lead_in_slots", emulation_.lead_in},
                 {"slots", slots_},
                 {"samples", samples_},
                 {"slots_per_second", slots_per_second}});
    run_.say(fmt::format("{}: part {} of {}, {} of {} emulated, {} kept, {} slots/s",
                         arguments_.output, arguments_.part.number, arguments_.part.count, emulated,
                         counted(pieces, "piece"), pieces - emulated, rounded(slots_per_second)));
}

}  // namespace

void emulate_part(const EmulateArguments& arguments, const RunOptions& run) {
    PartRun emulation(arguments, run);
    emulation.run();
    emulation.tell();
}

}  // namespace stipple
