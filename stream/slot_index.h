#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

/// Where a slot begins in the file.
struct IndexEntry {
    std::uint64_t slot = 0;
    std::uint64_t offset = 0;
};

inline constexpr std::size_t kIndexEntryBytes = 16;

/// The offsets of slots in a file of any length, in bounded memory: beyond `max_entries` entries it
/// keeps only every second one, then every fourth, and so on.
class SlotIndex {
  public:
    explicit SlotIndex(std::size_t max_entries = std::size_t{1} << 16U)
        : max_entries_(max_entries) {}

    /// Precondition: slots rise.
    void add(IndexEntry entry);
    [[nodiscard]] std::span<const IndexEntry> entries() const { return entries_; }

  private:
    std::size_t max_entries_;
    std::uint64_t stride_ = 1;
    std::vector<IndexEntry> entries_;
};

void store_index(std::span<const IndexEntry> entries, std::span<std::uint8_t> payload);
/// Precondition: a multiple of kIndexEntryBytes.
[[nodiscard]] std::vector<IndexEntry> load_index(std::span<const std::uint8_t> payload);

}  // namespace stipple
