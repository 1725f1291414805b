#include "python/call_progress.h"

#include <algorithm>
#include <utility>

#include "python/bindings.h"

namespace stipple::python {
namespace {

constexpr std::chrono::milliseconds kPause{100};

}  // namespace

void check_signals() {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

CallProgress::CallProgress(py::object tell, std::optional<std::int64_t> slots, Early early)
    : tell_(std::move(tell)),
      slots_(slots),
      early_(early),
      next_(std::chrono::steady_clock::now() + kPause) {}

bool CallProgress::reach(double slots) noexcept {
    done_ =
        slots_ ? std::min(slots, static_cast<double>(*slots_)) : slots;  // blocks go beyond `until`
    const auto now = std::chrono::steady_clock::now();
    if (raised_ || enough_ || now < next_) return !raised_ && !enough_;
    next_ = now + kPause;
    const py::gil_scoped_acquire gil;
    try {
        check_signals();
        say();
    } catch (...) {
        raised_ = std::current_exception();
    }
    return !raised_ && !enough_;
}

void CallProgress::finish() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
    check_signals();
    say();
}

void CallProgress::say() {
    if (tell_.is_none()) return;
    const py::object answer = tell_(done_, slots_);
    if (early_ == Early::kYes && answer.is(py::bool_(false))) enough_ = true;
}

}  // namespace stipple::python
