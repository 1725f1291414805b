#include "stream/slot_index.h"

#include <algorithm>

#include "stream/little_endian.h"

namespace stipple {

void SlotIndex::add(IndexEntry entry) {
    if (!entries_.empty() && entry.slot <= entries_.back().slot) return;
    if (entry.slot % stride_ != 0) return;
    if (entries_.size() == max_entries_) {
        stride_ *= 2;
        std::erase_if(entries_, [&](const IndexEntry& old) { return old.slot % stride_ != 0; });
        if (entry.slot % stride_ != 0) return;
    }
    entries_.push_back(entry);
}

std::optional<IndexEntry> last_before(std::span<const IndexEntry> entries, std::int64_t slot) {
    if (slot < 0) return std::nullopt;
    const auto after =
        std::ranges::upper_bound(entries, static_cast<std::uint64_t>(slot), {}, &IndexEntry::slot);
    return after == entries.begin() ? std::nullopt : std::optional(*(after - 1));
}

void store_index(std::span<const IndexEntry> entries, std::span<std::uint8_t> payload) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        store(&payload[i * kIndexEntryBytes], entries[i].slot);
        store(&payload[i * kIndexEntryBytes + 8], entries[i].offset);
    }
}

IndexEntries load_index(std::span<const std::uint8_t> payload, std::size_t switches) {
    const std::size_t slots = payload.size() / kIndexEntryBytes - switches;
    IndexEntries index;
    for (std::size_t i = 0; i < slots + switches; ++i)
        (i < slots ? index.slots : index.switches)
            .push_back({load<std::uint64_t>(&payload[i * kIndexEntryBytes]),
                        load<std::uint64_t>(&payload[i * kIndexEntryBytes + 8])});
    return index;
}

}  // namespace stipple
