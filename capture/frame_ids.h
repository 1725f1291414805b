#pragma once

#include <cstdint>
#include <optional>

namespace stipple {

/// Unwraps the frame ids of a camera to 64 bits that only grow. The first frame has id 0. A gap as
/// long as half the period cannot be told from a counter that began anew, and counts as that.
class FrameIds {
  public:
    /// Wire ids count modulo `period` (Camera::wire_id_period), at least 2.
    explicit FrameIds(std::uint64_t period) : period_(period) {}

    struct Step {
        std::uint64_t id = 0;
        std::uint64_t lost = 0;  ///< ids that were left out before it
        bool restarted = false;  ///< the camera's counter began anew, or repeated an id
    };
    /// The next frame has this wire id.
    [[nodiscard]] Step next(std::uint64_t wire_id) noexcept;

    /// Whether this wire id is that of the last frame, or of one that came, or was missed, earlier.
    [[nodiscard]] bool is_past(std::uint64_t wire_id) const noexcept;

    /// How far the counter moves from one wire id to another.
    [[nodiscard]] std::uint64_t steps(std::uint64_t from, std::uint64_t to) const noexcept;

    /// The camera begins anew, after so many frames that nobody numbered.
    void restart(std::uint64_t period, std::uint64_t skipped = 0) noexcept;

  private:
    std::uint64_t period_;
    std::uint64_t next_id_ = 0;
    std::optional<std::uint64_t> last_wire_id_;
};

}  // namespace stipple
