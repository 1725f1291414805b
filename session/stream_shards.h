#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "core/message.h"
#include "core/progress.h"
#include "io/pending_output.h"
#include "readout/sensor_file.h"
#include "session/emulation_source.h"
#include "session/shard.h"
#include "stream/stream_header.h"

namespace stipple {

/// An emulation whose pieces several processes share.
struct ShardedEmulation {
    EmulationSource source;  ///< of files, which are read more than once
    SensorSetup setup;
    std::int64_t lead_in;  ///< slots, of lead_in_slots(setup)
    StreamHeader header;   ///< of the whole stream
    std::function<void(const Message&)> warn = [](const Message&) {};
};

/// The slots of the footage: those that it declares, or else those that come when it is read.
/// `check` is called at each, and may throw to give up. \throws InputError if there is none.
[[nodiscard]] std::int64_t count_slots(const ShardedEmulation& emulation,
                                       const std::function<void()>& check);

/// A folder with a stream in pieces of kPieceSlots slots, each a complete file
/// `piece_000000.stipple` or absent. A piece is a stream that lacks the slots before it.
/// `emulation.json` holds the identity: the provenance, line by line, and the CRC of the header.
class StreamShards {
  public:
    /// Makes the folder if it is missing. `count_slots` is called if nobody has counted the slots
    /// of the footage yet. \throws InputError if the folder holds the pieces of another emulation,
    /// or anything else, or cannot be made; DeviceError if it cannot be written; as `count_slots`.
    StreamShards(std::filesystem::path folder, const StreamHeader& header,
                 const std::function<std::int64_t()>& count_slots);
    /// Opens the folder of an emulation. \throws InputError if it is none, or of another version.
    explicit StreamShards(std::filesystem::path folder);

    [[nodiscard]] std::int64_t slots() const { return slots_; }
    /// The slots of a piece: [begin_slot, end_slot).
    [[nodiscard]] std::int64_t begin_slot(std::int64_t number) const;
    [[nodiscard]] std::int64_t end_slot(std::int64_t number) const;
    /// The file of a piece.
    [[nodiscard]] std::filesystem::path piece(std::int64_t number) const;
    /// All of them, while this object lives.
    [[nodiscard]] NumberedFiles pieces() const;
    /// \throws InputError naming those that are missing.
    void require_all() const;

  private:
    [[nodiscard]] bool holds(std::int64_t number) const;

    std::filesystem::path folder_;
    std::uint32_t header_crc_ = 0;
    std::int64_t slots_ = 0;
};

/// Slots of a piece: some megabytes of VGA.
inline constexpr std::int64_t kPieceSlots = 64;

/// Whether a folder holds pieces.
[[nodiscard]] bool is_stream_shards(const std::filesystem::path& folder);

/// Emulates the pieces of a range, each after the slots of the lead-in, whose samples are
/// discarded. `progress` is called with the slots that are done before each slot, those of the
/// lead-in included. Returns the number of samples, or nothing if it has stopped the work.
/// \throws InputError if the footage has fewer slots than the folder tells, DeviceError.
[[nodiscard]] std::optional<std::uint64_t> emulate_pieces(
    const StreamShards& folder, const ShardedEmulation& emulation, const NumberRange& pieces,
    const std::function<bool(std::int64_t slots)>& progress);

/// Makes one stream of all pieces, with the bytes of that of one run. `progress` receives slots.
/// Returns the number of packets, or nothing if it has stopped the work. \throws InputError if a
/// piece is missing or damaged, DeviceError.
[[nodiscard]] std::optional<std::uint64_t> join_pieces(const StreamShards& folder,
                                                       PendingOutput& output,
                                                       const ProgressCallback& progress);

}  // namespace stipple
