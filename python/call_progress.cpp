#include "python/call_progress.h"

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "python/bindings.h"

namespace stipple::python {
namespace {

constexpr std::chrono::milliseconds kPause{100};

/// ThreadLimit as a context of `with`.
class Threads {
  public:
    explicit Threads(int threads) : threads_(threads) {
        if (threads < 0) throw py::value_error("threads: give 1 or more, or 0 for all cores");
    }
    void enter() { limit_.emplace(threads_); }
    void exit(const py::args& /*exception*/) { limit_.reset(); }

  private:
    int threads_;
    std::optional<ThreadLimit> limit_;
};

}  // namespace

CallProgress::CallProgress(py::object tell, std::optional<std::int64_t> slots)
    : tell_(std::move(tell)), slots_(slots), next_(std::chrono::steady_clock::now() + kPause) {}

bool CallProgress::reach(double slots) noexcept {
    done_ =
        slots_ ? std::min(slots, static_cast<double>(*slots_)) : slots;  // blocks go beyond `until`
    const auto now = std::chrono::steady_clock::now();
    if (raised_ || now < next_) return !raised_;
    next_ = now + kPause;
    const py::gil_scoped_acquire gil;
    try {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        say();
    } catch (...) {
        raised_ = std::current_exception();
    }
    return !raised_;
}

void CallProgress::finish() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    say();
}

void CallProgress::say() {
    if (!tell_.is_none()) tell_(done_, slots_);
}

void bind_threads(py::module_& module) {
    py::class_<Threads>(module, "Threads")
        .def(py::init<int>(), py::arg("threads"))
        .def("__enter__", &Threads::enter)
        .def("__exit__", &Threads::exit);
}

}  // namespace stipple::python
