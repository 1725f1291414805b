#include "apps/join_stream.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "apps/interrupt.h"
#include "apps/piece_folder.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "core/error.h"
#include "io/pending_output.h"
#include "stream/packet_order.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

class StreamJoin {
  public:
    StreamJoin(const std::string& output, bool force) : output_(output, force) {}

    /// Appends the slots up to `end` from a piece. \throws InputError if it does not have them.
    void append(const std::filesystem::path& piece, std::int64_t end, Progress& progress) {
        const auto require = [&piece](bool good) {
            if (!good)
                throw InputError(piece.string(),
                                 "is damaged; remove it, and run `stipple emulate --part` again");
        };
        StreamReader reader(piece);
        if (!writer_) {
            order_.emplace(reader.header().shape.rows);
            writer_.emplace(output_.partial(), reader.header(), output_.final_path().string());
        }
        for (SamplePacket packet; reader.next(packet);) {
            throw_if_stopped();
            require(StreamPosition{packet.slot, packet.first_row} == order_->expected());
            writer_->write(packet);
            ++packets_;
            order_->advance(packet.rows);
            progress.reach(static_cast<double>(order_->expected().slot));
        }
        require(order_->expected() == StreamPosition{end, 0});
    }
    void finish() {
        writer_->finish();
        output_.commit();
    }
    [[nodiscard]] std::uint64_t packets() const { return packets_; }

  private:
    PendingOutput output_;
    std::optional<PacketOrder> order_;
    std::optional<StreamWriter> writer_;
    std::uint64_t packets_ = 0;
};

}  // namespace

void join_stream(const std::filesystem::path& name, const std::string& output,
                 const RunOptions& run) {
    const PieceFolder folder(name);
    const NumberedParts pieces = folder.pieces();
    pieces.require_all(name, kEmulationFolder);
    JsonFile json(run);
    say_leftover(output);
    StreamJoin stream(output, run.force);
    Progress progress(run, "joining", folder.slots(), "slot");
    for (std::int64_t number = 0; number < pieces.count; ++number)
        stream.append(folder.piece(number), folder.end_slot(number), progress);
    stream.finish();
    json.write(
        {{"slots", folder.slots()}, {"pieces", pieces.count}, {"packets", stream.packets()}});
    run.say(fmt::format("{}: {} of {}", output, counted(folder.slots(), "slot"),
                        counted(pieces.count, "piece")));
}

}  // namespace stipple
