#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stream/buffered_reader.h"
#include "stream/packet_codec.h"

namespace stipple {

/// Where a slot begins in the file.
struct IndexEntry {
    std::uint64_t slot = 0;
    std::uint64_t offset = 0;
};

inline constexpr std::size_t kIndexEntryBytes = 16;

/// The last of `entries`, whose slots rise, that is not after `slot`.
[[nodiscard]] std::optional<IndexEntry> last_before(std::span<const IndexEntry> entries,
                                                    std::int64_t slot);

/// The offsets of slots in a file of any length, in bounded memory: beyond `max_entries` entries it
/// keeps only every second one, then every fourth, and so on.
class SlotIndex {
  public:
    explicit SlotIndex(std::size_t max_entries = std::size_t{1} << 16U)
        : max_entries_(max_entries) {}

    /// Slots rise; one that does not is left out.
    void add(IndexEntry entry);
    [[nodiscard]] std::span<const IndexEntry> entries() const { return entries_; }

  private:
    std::size_t max_entries_;
    std::uint64_t stride_ = 1;
    std::vector<IndexEntry> entries_;
};

void store_index(std::span<const IndexEntry> entries, std::span<std::uint8_t> payload);

/// The content of an index: where slots, and where switches of the schedule begin.
struct IndexEntries {
    std::vector<IndexEntry> slots;
    std::vector<IndexEntry> switches;
};

/// Precondition: a multiple of kIndexEntryBytes, of which there are `switches` or more.
[[nodiscard]] IndexEntries load_index(std::span<const std::uint8_t> payload, std::size_t switches);

/// What the end of a whole stream tells.
struct TrailingIndex {
    std::int64_t slots = 0;                 ///< in the stream
    std::optional<std::uint32_t> checksum;  ///< of all packets; none in version 1
    IndexEntries entries;
};

/// The index that the end marker of a file points to. Nothing if there is no index, if it is
/// damaged, or if it is not where the marker says (then bytes of the file are missing, and no
/// offset is correct).
[[nodiscard]] std::optional<TrailingIndex> read_trailing_index(const BufferedReader& file,
                                                               const Framing& framing);

/// Its number of slots.
[[nodiscard]] std::optional<std::int64_t> slots_by_index(const BufferedReader& file,
                                                         const Framing& framing);

/// A place to begin at, and where the switches of the schedule are.
struct IndexPlace {
    IndexEntry begin;
    std::vector<IndexEntry> switches;
};

/// Its last entry that is not after `slot`, if the first packet of that slot begins there.
[[nodiscard]] std::optional<IndexPlace> entry_before(const BufferedReader& file,
                                                     const Framing& framing, std::int64_t slot);

/// Message on the first entry of an index that does not point to the first packet of its slot, or
/// to its switch. Nothing if all do, or if `file` is a pipe.
[[nodiscard]] std::optional<std::string> wrong_entry(const IndexEntries& entries,
                                                     const BufferedReader& file,
                                                     const Framing& framing);

}  // namespace stipple
