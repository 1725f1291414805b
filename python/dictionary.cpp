#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/exposure_schedule.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/errors.h"
#include "python/footage.h"
#include "session/dictionary_training.h"

namespace stipple::python {
namespace {

DictionarySettings dictionary_settings(const py::dict& numbers) {
    DictionarySettings settings;
    const auto take = [&](const char* name, std::uint64_t min, std::uint64_t max) {
        const std::uint64_t number = whole_in(numbers[name], name);
        if (number < min || number > max)
            throw InputError(name, fmt::format("{} is outside {}..{}", number, min, max));
        return number;
    };
    const auto take_int = [&](const char* name, int min, int max) {
        return static_cast<int>(
            take(name, static_cast<std::uint64_t>(min), static_cast<std::uint64_t>(max)));
    };
    settings.shape.slots = take_int("slots", 1, kMaxExposureSlots);
    settings.shape.side_px = take_int("side", 2, DictionarySettings::kMaxSidePx);
    settings.learning.atoms = take_int("atoms", 2, DictionarySettings::kMaxAtoms);
    settings.learning.sparsity = take_int("sparsity", 1, DictionarySettings::kMaxSparsity);
    settings.learning.iterations = take_int("iterations", 1, DictionarySettings::kMaxIterations);
    settings.patches = take("patches", 2, DictionarySettings::kMaxPatches);
    settings.learning.seed = whole_in(numbers["seed"], "seed");
    return settings;
}

struct Stopped {};

/// A dictionary that is learnt, and the file that it goes to.
class DictionaryTask {
  public:
    DictionaryTask(const py::dict& numbers, const std::optional<std::filesystem::path>& output,
                   bool force)
        : settings_(dictionary_settings(numbers)), training_(settings_) {
        if (!output) return;
        check_name(*output, kDictionaryName);
        pending_ =
            creating(*output, [&] { return std::make_unique<PendingOutput>(*output, force); });
    }

    /// Takes the patches of a clip.
    void add_clip(Footage& footage) {
        CallProgress progress(py::none(), std::nullopt);
        try {
            const py::gil_scoped_release released;
            training_.add_clip({.name = footage.name(),
                                .shape = footage.shape(),
                                .filter = footage.filter(),
                                .next = [&] {
                                    if (!progress.reach(0)) throw Stopped{};
                                    return footage.next();
                                }});
        } catch (const Stopped&) {  // `finish` says why
        }
        progress.finish();
        footage.pass_warnings_on();
    }

    /// The array (atom, slot, pixel).
    py::array learn(const py::object& tell) {
        CallProgress progress(tell, settings_.learning.iterations);
        PatchDictionary dictionary;
        {
            const py::gil_scoped_release released;
            dictionary = training_.learn([&](int, double) { return progress.reach(++done_); });
        }
        progress.finish();
        if (pending_) write_dictionary(dictionary, *pending_);
        return py::array_t<float>(
            {py::ssize_t{dictionary.atoms}, py::ssize_t{dictionary.shape.slots},
             static_cast<py::ssize_t>(dictionary.shape.pixels())},
            dictionary.values.data());
    }

  private:
    DictionarySettings settings_;
    DictionaryTraining training_;
    std::unique_ptr<PendingOutput> pending_;
    double done_ = 0;
};

}  // namespace

void bind_dictionary(py::module_& module) {
    py::class_<DictionaryTask>(module, "DictionaryTask")
        .def(py::init<const py::dict&, const std::optional<std::filesystem::path>&, bool>())
        .def("add_clip", &DictionaryTask::add_clip)
        .def("learn", &DictionaryTask::learn);
}

}  // namespace stipple::python
