#include "session/stream_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/version.h"
#include "readout/emulator.h"
#include "session/shard_folder.h"
#include "stream/buffered_reader.h"
#include "stream/header_codec.h"
#include "stream/packet_codec.h"
#include "stream/packet_order.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kMaxSlots = std::int64_t{1} << 53U;  // of a stream

nlohmann::ordered_json json_of(const std::string& provenance, std::uint32_t header_crc,
                               std::int64_t slots) {
    auto lines = nlohmann::ordered_json::array();
    std::istringstream text(provenance);
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return {{"version", version()},
            {"provenance", lines},
            {"header_crc", header_crc},
            {"piece_slots", kPieceSlots},
            {"slots", slots}};
}

/// The slots that the identity of an emulation tells. \throws InputError if its numbers cannot be.
std::int64_t slots_of(const nlohmann::ordered_json& json, const fs::path& folder) {
    const nlohmann::ordered_json& slots = json["slots"];
    const bool whole = slots.is_number_integer() && json["header_crc"].is_number_unsigned();
    if (!whole || slots < 1 || slots > kMaxSlots)
        throw InputError((folder / kEmulationFolder.identity).string(),
                         "has a number that no stream has; emulate again");
    return slots;
}

nlohmann::ordered_json read_identity(const fs::path& folder) {
    return parsed_identity(stored_identity(folder, kEmulationFolder),
                           folder / kEmulationFolder.identity, kEmulationFolder, json_of({}, 0, 0));
}

std::uint32_t crc_of(const StreamHeader& header) {
    return framing_of(encode_header(header, "sensor")).seed;
}

/// Pieces of a stream, written one after the other.
class PieceWriter {
  public:
    PieceWriter(const StreamShards& folder, const StreamHeader& header, std::int64_t first)
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
        const fs::path file = folder_.piece(number_);
        remove_leftovers(file);
        output_.emplace(file, true, OutputKind::kManagedFile);
        writer_.emplace(output_->partial(), header_, file.string(), folder_.begin_slot(number_));
    }

    const StreamShards& folder_;
    const StreamHeader& header_;
    std::int64_t number_;
    std::uint64_t samples_ = 0;
    std::optional<PendingOutput> output_;
    std::optional<StreamWriter> writer_;
};

/// The slots of pieces, written in their order to one stream.
class PieceJoiner {
  public:
    explicit PieceJoiner(PendingOutput& output) : output_(output) {}

    /// Appends the slots up to `end` from a piece. Returns false if `progress` has stopped it.
    /// \throws InputError if the piece does not have them.
    bool append(const fs::path& piece, std::int64_t end, const ProgressCallback& progress) {
        const auto require = [&piece](bool good) {
            if (!good) throw InputError(piece.string(), "is damaged; remove it, and emulate again");
        };
        StreamReader reader(piece);
        if (!writer_) {
            order_.emplace(reader.header().shape.rows);
            writer_.emplace(output_.partial(), reader.header(), output_.final_path().string());
        }
        for (SamplePacket packet; reader.next(packet);) {
            require(StreamPosition{packet.slot, packet.first_row} == order_->expected());
            writer_->write(packet);
            ++packets_;
            order_->advance(packet.rows);
            if (!progress(static_cast<double>(order_->expected().slot))) return false;
        }
        require(order_->expected() == StreamPosition{end, 0});
        return true;
    }
    void finish() {
        writer_->finish();
        output_.commit();
    }
    [[nodiscard]] std::uint64_t packets() const { return packets_; }

  private:
    PendingOutput& output_;
    std::optional<PacketOrder> order_;
    std::optional<StreamWriter> writer_;
    std::uint64_t packets_ = 0;
};

}  // namespace

StreamShards::StreamShards(fs::path folder, const StreamHeader& header,
                           const std::function<std::int64_t()>& count_slots)
    : folder_(std::move(folder)), header_crc_(crc_of(header)) {
    slots_ = is_stream_shards(folder_) ? slots_of(read_identity(folder_), folder_) : count_slots();
    claim_folder(folder_, kEmulationFolder, json_of(header.provenance, header_crc_, slots_));
}

StreamShards::StreamShards(fs::path folder) : folder_(std::move(folder)) {
    const auto pattern = json_of({}, 0, 0);
    const auto json = read_identity(folder_);
    if (json["version"] != pattern["version"] || json["piece_slots"] != pattern["piece_slots"])
        throw InputError(folder_.string(),
                         fmt::format("is of another version of this program: {} there and {} here",
                                     json["version"].dump(), pattern["version"].dump()));
    slots_ = slots_of(json, folder_);
    header_crc_ = json["header_crc"];
}

std::int64_t StreamShards::begin_slot(std::int64_t number) const {
    return number * kPieceSlots;
}

std::int64_t StreamShards::end_slot(std::int64_t number) const {
    return std::min((number + 1) * kPieceSlots, slots_);
}

fs::path StreamShards::piece(std::int64_t number) const {
    return folder_ / fmt::format("piece_{:06d}.stipple", number);
}

NumberedFiles StreamShards::pieces() const {
    return {(slots_ + kPieceSlots - 1) / kPieceSlots,
            [this](std::int64_t number) { return piece(number); },
            [this](std::int64_t number) { return holds(number); }};
}

/// Whether the piece is there, and has the header of the emulation and an end.
bool StreamShards::holds(std::int64_t number) const {
    const fs::path file = piece(number);
    if (!fs::exists(file)) return false;
    try {
        BufferedReader window(file);
        const std::size_t bytes = header_bytes(window.peek(kHeaderStartBytes), file.string());
        const auto header = window.peek(bytes);
        if (header.size() < bytes) return false;
        const Framing framing = framing_of(header);
        const std::size_t marker_bytes = end_marker_bytes(framing);
        const std::uint64_t end = window.file_bytes().value_or(0);
        if (framing.seed != header_crc_ || end < bytes + marker_bytes) return false;
        const auto marker = window.read_at(end - marker_bytes, marker_bytes);
        return marker && start_of(*marker, framing) == Start::kEnd;
    } catch (const InputError&) {
        return false;  // as after a power cut with --no-sync
    }
}

void StreamShards::require_all() const {
    pieces().require_all(folder_, kEmulationFolder);
}

bool is_stream_shards(const fs::path& folder) {
    return fs::exists(folder / kEmulationFolder.identity);
}

std::int64_t count_slots(const ShardedEmulation& emulation, const std::function<void()>& check) {
    const EmulationSource& source = emulation.source;
    ReadAhead footage = source.open(emulation.warn);
    ResampledFootage slots = source.slots_of(footage, emulation.setup.params.slot_us);
    std::int64_t count = slots.slots().value_or(0);
    if (!slots.slots())
        for (; !slots.next().empty(); ++count) check();
    if (count == 0) refuse_short_footage(source.footage);
    return count;
}

std::optional<std::uint64_t> emulate_pieces(
    const StreamShards& folder, const ShardedEmulation& emulation, const NumberRange& pieces,
    const std::function<bool(std::int64_t slots)>& progress) {
    constexpr int kSkip = 1024;  // frames between calls of `progress`
    const EmulationSource& source = emulation.source;
    const std::int64_t begin = folder.begin_slot(pieces.begin);
    const std::int64_t end = folder.end_slot(pieces.end - 1);
    const std::int64_t first = std::max<std::int64_t>(begin - emulation.lead_in, 0);

    ReadAhead footage = source.open(emulation.warn);
    ResampledFootage slots = source.slots_of(footage, emulation.setup.params.slot_us);
    for (std::int64_t skipped = 0; skipped < first; skipped += kSkip) {
        if (!progress(0)) return {};
        slots.skip(static_cast<int>(std::min<std::int64_t>(first - skipped, kSkip)));
    }

    Emulator emulator(emulation.setup, first);
    PieceWriter writer(folder, emulation.header, pieces.begin);
    for (std::int64_t slot = first; slot < end; ++slot) {
        if (!progress(std::max<std::int64_t>(slot - begin, 0))) return {};
        const auto frame = slots.next();
        if (frame.empty())
            throw InputError(source.footage,
                             fmt::format("ends before slot {}, but has {} slots by {}", slot,
                                         folder.slots(), kEmulationFolder.identity));
        const auto packets = emulator.expose(frame);
        if (slot >= begin) writer.write(packets, slot);
    }
    return writer.samples();
}

std::optional<std::uint64_t> join_pieces(const StreamShards& folder, PendingOutput& output,
                                         const ProgressCallback& progress) {
    const NumberedFiles pieces = folder.pieces();
    PieceJoiner stream(output);
    for (std::int64_t number = 0; number < pieces.count; ++number)
        if (!stream.append(folder.piece(number), folder.end_slot(number), progress)) return {};
    stream.finish();
    return stream.packets();
}

}  // namespace stipple
