#include "apps/emulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <system_error>
#include <vector>

#include "apps/interrupt.h"
#include "apps/piece_folder.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "core/error.h"
#include "io/pending_output.h"
#include "readout/emulator.h"
#include "readout/lead_in.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

constexpr auto kGoOn = "complete pieces are kept, and the same command goes on";
constexpr int kSkip = 1024;  ///< frames between looks for a signal

/// The same, if the footage can be read more than once. \throws InputError.
const EmulateArguments& of_files(const EmulateArguments& arguments) {
    std::error_code error;
    const auto type = std::filesystem::status(arguments.footage, error).type();
    if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::character)
        throw InputError(arguments.footage, "--part needs files, which are read more than once");
    return arguments;
}

/// The slots that the footage declares, or else those that come when it is read.
std::int64_t count_slots(const EmulateArguments& arguments, EmulationInput& input) {
    if (const auto declared = input.slots().slots()) return *declared;
    ReadAhead footage = read_footage(arguments.footage, arguments.reading);
    ResampledFootage slots = slots_of(footage, arguments, input.setup().params.slot_us);
    std::int64_t count = 0;
    for (; !slots.next().empty(); ++count) throw_if_stopped();
    return count;
}

/// Pieces of a stream, written one after the other.
class PieceWriter {
  public:
    PieceWriter(const PieceFolder& folder, const StreamHeader& header, std::int64_t first)
        : folder_(folder), header_(header), number_(first) {}

    /// Writes the packets of a slot.
    void write(std::span<const SamplePacket> packets, std::int64_t slot) {
        if (!writer_) begin();
        for (const SamplePacket& packet : packets) {
            writer_->write(packet);
            samples_ += packet.dn.size();
        }
        if (slot + 1 < folder_.end_slot(number_)) return;
        writer_->finish();
        output_->commit();
        writer_.reset();
        output_.reset();
        ++number_;
    }
    [[nodiscard]] std::uint64_t samples() const { return samples_; }

  private:
    void begin() {
        const std::filesystem::path file = folder_.piece(number_);
        remove_leftovers(file);
        output_.emplace(file, true, OutputKind::kManagedFile);
        writer_.emplace(output_->partial(), header_, file.string(), folder_.begin_slot(number_));
    }

    const PieceFolder& folder_;
    const StreamHeader& header_;
    std::int64_t number_;
    std::uint64_t samples_ = 0;
    std::optional<PendingOutput> output_;
    std::optional<StreamWriter> writer_;
};

/// A run of the command: opened by the constructor, then `run`, then `tell`.
class PartRun {
  public:
    PartRun(const EmulateArguments& arguments, const RunOptions& run);
    /// Emulates the pieces that are missing. \throws Interrupted, InputError, DeviceError.
    void run();
    void tell();

  private:
    void emulate_pieces(const NumberRange& pieces, Progress& progress);
    [[nodiscard]] std::int64_t slots_of_range(const NumberRange& pieces) const;

    const EmulateArguments& arguments_;
    const RunOptions& run_;
    EmulationInput input_;
    std::int64_t lead_in_;
    StreamHeader header_;
    JsonFile json_;
    PieceFolder folder_;
    NumberRange pieces_;
    std::vector<std::int64_t> missing_;
    std::int64_t slots_ = 0;  ///< written in this run
    std::uint64_t samples_ = 0;
    double seconds_ = 0;
};

PartRun::PartRun(const EmulateArguments& arguments, const RunOptions& run)
    : arguments_(arguments),
      run_(run),
      input_(of_files(arguments)),
      lead_in_(lead_in_slots(input_.setup())),
      header_(stream_header_of(input_.setup(),
                               provenance_of(input_.setup(), footage_origin(arguments)))),
      json_(run),
      folder_(arguments.output, header_,
              [&] {
                  const std::int64_t slots = count_slots(arguments, input_);
                  if (slots == 0) refuse_short_footage(arguments.footage);
                  return slots;
              }),
      pieces_(range_of(arguments.part, folder_.pieces().count)) {
    if (!run.force)
        missing_ = folder_.pieces().missing(pieces_.begin, pieces_.end);
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
    for (const NumberRange& range : ranges) emulate_pieces(range, progress);
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void PartRun::emulate_pieces(const NumberRange& pieces, Progress& progress) {
    const std::int64_t begin = folder_.begin_slot(pieces.begin);
    const std::int64_t first = std::max<std::int64_t>(begin - lead_in_, 0);
    ReadAhead footage = read_footage(arguments_.footage, arguments_.reading);
    ResampledFootage slots = slots_of(footage, arguments_, input_.setup().params.slot_us);
    for (std::int64_t skipped = 0; skipped < first; skipped += kSkip) {
        throw_if_stopped(kGoOn);
        slots.skip(static_cast<int>(std::min<std::int64_t>(first - skipped, kSkip)));
    }
    Emulator emulator(input_.setup(), first);
    PieceWriter writer(folder_, header_, pieces.begin);
    const std::int64_t end = folder_.end_slot(pieces.end - 1);
    for (std::int64_t slot = first; slot < end; ++slot) {
        throw_if_stopped(kGoOn);
        const auto frame = slots.next();
        if (frame.empty())
            throw InputError(arguments_.footage,
                             fmt::format("ends before slot {}, but has {} slots by {}", slot,
                                         folder_.slots(), kEmulationFolder.identity));
        const auto packets = emulator.expose(frame);
        if (slot < begin) continue;
        writer.write(packets, slot);
        ++slots_;
        progress.advance();
    }
    samples_ += writer.samples();
}

void PartRun::tell() {
    const std::int64_t pieces = pieces_.end - pieces_.begin;
    const auto emulated = static_cast<std::int64_t>(missing_.size());
    const double slots_per_second = slots_ == 0 ? 0 : static_cast<double>(slots_) / seconds_;
    json_.write({{"part", arguments_.part.number},
                 {"parts", arguments_.part.count},
                 {"pieces", pieces},
                 {"pieces_emulated", emulated},
                 {"lead_in_slots", lead_in_},
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
