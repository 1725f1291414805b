#pragma once

#include <cstdint>
#include <optional>

namespace stipple {

/// Unwraps the frame ids of a camera to increasing 64-bit ids. The first frame has id 0. A gap of
/// more than half the period looks like a restart of the camera's counter, and counts as a restart.
class FrameIds {
  public:
    /// Wire ids count modulo `period` (Camera::wire_id_period). Precondition: period >= 2.
    explicit FrameIds(std::uint64_t period) : period_(period) {}

    struct Step {
        std::uint64_t id = 0;
        std::uint64_t lost = 0;  ///< skipped ids before it
        bool restarted = false;  ///< the counter of the camera restarted, or repeated an id
    };
    /// Takes the wire id of the next frame.
    [[nodiscard]] Step next(std::uint64_t wire_id) noexcept;

    /// Whether this wire id belongs to the last frame or to an earlier one, received or lost.
    [[nodiscard]] bool is_past(std::uint64_t wire_id) const noexcept;

    /// Number of ids from one wire id to another, modulo the period.
    [[nodiscard]] std::uint64_t steps(std::uint64_t from, std::uint64_t to) const noexcept;

    /// The camera restarts after `skipped` frames without ids.
    void restart(std::uint64_t period, std::uint64_t skipped = 0) noexcept;

  private:
    std::uint64_t period_;
    std::uint64_t next_id_ = 0;
    std::optional<std::uint64_t> last_wire_id_;
};

}  // namespace stipple
