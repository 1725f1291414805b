#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace stipple {

/// A row of a slot. Sample packets come by slot, then by row.
struct StreamPosition {
    std::int64_t slot = 0;
    int row = 0;
    auto operator<=>(const StreamPosition&) const = default;
};

/// Follows the sample packets of a stream and finds gaps between them.
class PacketOrder {
  public:
    explicit PacketOrder(int array_rows) : array_rows_(array_rows) {}

    /// The slots before `slot` are left out, and not missing. Precondition: nothing came yet.
    void begin_at(std::int64_t slot) {
        expected_ = {slot, 0};
        counted_ = slot;
    }
    /// Where the next packet begins if nothing is missing.
    [[nodiscard]] StreamPosition expected() const { return expected_; }
    /// Advances to `next` and counts slots with missing rows.
    /// Precondition: next >= expected().
    void skip_to(StreamPosition next);
    /// Advances by `rows` rows of a slot. Precondition: the slot has them.
    void advance(int rows);

    /// Slots with missing rows.
    [[nodiscard]] std::int64_t missing_slots() const { return missing_slots_; }
    /// The gap that `skip_to(next)` would skip: "slot 3 from row 4 to slot 5 row 7 is missing".
    [[nodiscard]] std::string missing_before(StreamPosition next) const;

  private:
    int array_rows_;
    StreamPosition expected_;
    std::int64_t missing_slots_ = 0;
    std::int64_t counted_ = 0;  ///< slots below are counted if they miss rows
};

}  // namespace stipple
