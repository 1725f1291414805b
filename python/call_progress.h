#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <cstdint>
#include <exception>
#include <optional>

namespace stipple::python {

/// Raises what Ctrl-C raises, if it was pressed. With the GIL.
void check_signals();

/// Tells Python how far a long call has come, some ten times a second, and lets Ctrl-C end it.
class CallProgress {
  public:
    /// Whether a call can end early, with what it has so far, when `tell` returns False.
    enum class Early : std::uint8_t { kNo, kYes };

    /// `tell` is None or called as tell(slots done, slots in all or None); what it raises ends the
    /// call. With the GIL.
    CallProgress(pybind11::object tell, std::optional<std::int64_t> slots,
                 Early early = Early::kNo);

    /// Without the GIL. False if the call is to end.
    [[nodiscard]] bool reach(double slots) noexcept;
    /// Tells of the end, or raises what has ended the call. With the GIL.
    void finish();

  private:
    void say();

    pybind11::object tell_;
    std::optional<std::int64_t> slots_;
    Early early_;
    bool enough_ = false;
    double done_ = 0;
    std::chrono::steady_clock::time_point next_;
    std::exception_ptr raised_;
};

}  // namespace stipple::python
