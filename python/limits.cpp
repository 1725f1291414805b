#include <cstdint>
#include <optional>
#include <string>

#include "core/error.h"
#include "core/memory_limit.h"
#include "core/parallel.h"
#include "python/bindings.h"

namespace stipple::python {
namespace {

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

/// MemoryLimit as a context of `with`.
class MaxMemory {
  public:
    explicit MaxMemory(const std::string& text) {
        const auto bytes = parse_memory(text);
        if (!bytes)
            throw InputError("MaxMemory", "\"" + text + "\" is not a size of at least 1M, like 2G");
        bytes_ = *bytes;
    }
    void enter() { limit_.emplace(bytes_); }
    void exit(const py::args& /*exception*/) { limit_.reset(); }

  private:
    std::uint64_t bytes_ = 0;
    std::optional<MemoryLimit> limit_;
};

}  // namespace

void bind_limits(py::module_& module) {
    py::class_<MaxMemory>(
        module, "MaxMemory",
        R"(with MaxMemory("2G"): what calls may take of memory, instead of a quarter of the
machine's; K, M, G and T are powers of 1024. One at a time, for all threads.)")
        .def(py::init<const std::string&>(), py::arg("size"))
        .def("__enter__", &MaxMemory::enter)
        .def("__exit__", &MaxMemory::exit);
    py::class_<Threads>(module, "Threads")
        .def(py::init<int>(), py::arg("threads"))
        .def("__enter__", &Threads::enter)
        .def("__exit__", &Threads::exit);
}

}  // namespace stipple::python
