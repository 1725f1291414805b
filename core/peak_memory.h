#pragma once

#include <cstdint>
#include <optional>

namespace stipple {

/// Measures the most memory that work adds to what the process has in RAM. The mark is that of the
/// process: one at a time, and other threads count too.
class PeakMemory {
  public:
    /// Gives freed memory back to the system, and forgets the most that ever lay in RAM.
    PeakMemory();
    /// Bytes since the construction; none where the system does not tell.
    [[nodiscard]] std::optional<std::uint64_t> bytes() const;

  private:
    std::optional<std::uint64_t> before_;
};

}  // namespace stipple
