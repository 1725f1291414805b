#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "python/bindings.h"
#include "python/footage.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "readout/coded_sensor.h"
#include "readout/schedule_feasibility.h"
#include "study/training/moving_crop.h"
#include "study/training/training_item.h"

namespace stipple::python {
namespace {

using Light = py::array_t<float, py::array::c_style>;

/// Clips whose planes are one after the other: (frame, row, col) or (frame, plane, row, col).
Clip clip_of(const Light& light) {
    if (light.ndim() != 3 && light.ndim() != 4)
        throw InputError("clip", "is not an array (frame, row, col) or (frame, plane, row, col)");
    const auto size = [&](py::ssize_t axis) { return static_cast<int>(light.shape(axis)); };
    const FrameShape shape{size(light.ndim() - 2), size(light.ndim() - 1),
                           light.ndim() == 4 ? size(1) : 1};
    const std::span<const float> values(light.data(), static_cast<std::size_t>(light.size()));
    return {values, size(0), shape};
}

/// A sensor with its schedule, made for crops of a size.
class TrainingChip {
  public:
    TrainingChip(const py::object& sensor, const py::object& schedule, int rows, int cols,
                 int planes)
        : setup_(set_up(with_seed_of(schedule, sensor_of(sensor)), schedule,
                        FrameShape{.rows = rows, .cols = cols, .planes = planes},
                        ColourFilter::kNone)) {
        if (const auto problem =
                store_problem(setup_.schedule.schedule, setup_.params.charge_stores))
            throw InputError("schedules", *problem);
    }

    /// Light of the crop, and its samples.
    std::pair<py::array, std::unique_ptr<ForwardModel>> item(const Light& light,
                                                             const MovingCrop& crop,
                                                             std::uint64_t seed) const {
        const Clip clip = clip_of(light);
        auto truth = std::make_unique<std::vector<float>>();
        std::unique_ptr<ForwardModel> model;
        {
            const py::gil_scoped_release released;
            *truth = take_crop(clip, crop, setup_.footage);
            model = std::make_unique<ForwardModel>(samples_of_light(setup_, seed, *truth));
        }
        return {as_array(std::move(truth), setup_.footage), std::move(model)};
    }

  private:
    SensorSetup setup_;
};

/// The numbers of a sensor whose pixels are equal, linear and independent of each other.
py::dict plain_noise_of(const py::object& sensor) {
    const SensorParams params = sensor_of(sensor).description.params;
    const PhysicalTerms& terms = params.physical;
    PhysicalTerms plain;
    plain.quantum_efficiency = terms.quantum_efficiency;
    plain.dark_current_e_per_s = terms.dark_current_e_per_s;
    plain.dark_reference_c = terms.dark_reference_c;
    plain.temperature_c = terms.temperature_c;
    plain.dark_doubling_c = terms.dark_doubling_c;
    plain.reset_noise_e = terms.reset_noise_e;
    plain.black_level_dn = terms.black_level_dn;
    plain.device_id = terms.device_id;
    if (plain != terms)
        throw InputError(fmt::format("sensor {}", params.name),
                         "has terms of mode \"physical\" by which pixels differ, are not linear or "
                         "depend on each other, such as PRNU, row noise or lag: set them to their "
                         "defaults");
    const Calibration calibration = calibration_of(params);
    py::dict numbers;
    numbers["max_dn"] = (1 << calibration.bit_depth) - 1;
    numbers["floor"] = calibration.rounding == Rounding::kFloor;
    numbers["black_level_dn"] = calibration.black_level_dn;
    numbers["gain_e_per_dn"] = calibration.gain_e_per_dn;
    numbers["read_noise_e"] = calibration.read_noise_e;
    numbers["full_well_e"] = calibration.full_well_e;
    numbers["electrons_per_unit"] = calibration.electrons_per_unit;
    numbers["dark_e_per_slot"] = calibration.dark_e_per_slot;
    numbers["shot_noise"] = params.shot_noise;
    return numbers;
}

}  // namespace

void bind_training(py::module_& module) {
    py::class_<MovingCrop>(module, "MovingCrop")
        .def(py::init([](double first_frame, double frames_per_slot, std::vector<double> top,
                         std::vector<double> left, double light, double contrast) {
            return MovingCrop{.first_frame = first_frame,
                              .frames_per_slot = frames_per_slot,
                              .top = std::move(top),
                              .left = std::move(left),
                              .light = light,
                              .contrast = contrast};
        }));
    py::class_<TrainingChip>(module, "TrainingChip")
        .def(py::init<const py::object&, const py::object&, int, int, int>())
        .def("item", &TrainingChip::item);
    module.def("plain_noise", &plain_noise_of);
}

}  // namespace stipple::python
