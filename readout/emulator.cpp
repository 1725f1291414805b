#include "readout/emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "readout/light_throughput.h"
#include "readout/sensor_file.h"
#include "sensor_model/slot_light.h"
#include "stream/schedule_switch.h"

namespace stipple {
namespace {

/// The light of a slot behind the grey mask of a schedule with weights.
void mask(const ExposureSchedule& schedule, std::int64_t slot, FrameShape shape,
          std::span<const float> frame, std::span<float> masked) {
    const auto phase = static_cast<int>(slot % schedule.period_slots());
    parallel_for(0, shape.planes * shape.rows, [&](int line) {
        const int tile_row = line % shape.rows % schedule.tile_rows();
        const std::size_t begin = index(line) * index(shape.cols);
        for (int col = 0; col < shape.cols; ++col) {
            const float weight = schedule.weight(phase, tile_row, col % schedule.tile_cols());
            masked[begin + index(col)] = weight * frame[begin + index(col)];
        }
    });
}

}  // namespace

StreamHeader stream_header_of(const SensorSetup& setup, std::string provenance) {
    return {.shape = setup.shape,
            .slot_us = setup.params.slot_us,
            .calibration = calibration_of(setup.params),
            .schedule = setup.schedule.schedule,
            .schedule_source = setup.schedule.source,
            .schedule_name = setup.schedule.name,
            .provenance = std::move(provenance),
            .cfa = setup.params.physical.cfa};
}

Emulator::Emulator(const SensorSetup& setup, std::int64_t first_slot)
    : setup_(setup),
      filters_(calibration_of(setup.params).tile),
      sensor_(setup.params, setup.shape, setup.schedule.schedule, setup.seed, first_slot) {
    if (!setup.timing) return;
    const SlotBudget budget{slot_clocks(*setup.timing, setup.params.slot_us), setup.overrun};
    readout_cost_.emplace(*setup.timing, setup.schedule.schedule, setup.shape, budget);
    readout_cost_->begin_at(first_slot);
}

void Emulator::switch_to(const SensorSetup& next) {
    check_switch(setup_, next, stats().slots);
    schedules_.push_back(next.schedule.schedule);
    sensor_.switch_to(next.params, schedules_.back());
    if (readout_cost_) readout_cost_->switch_to(schedules_.back());
}

/// Behind colour filters and a grey mask.
std::span<const float> Emulator::light_on_pixels(std::span<const float> frame) {
    const ColourFilter filter = setup_.params.physical.cfa;
    if (filter != ColourFilter::kNone && setup_.footage.planes == 3) {
        mosaic_.resize(setup_.shape.pixels());
        take_mosaic(filter, setup_.footage, frame, mosaic_);
        frame = mosaic_;
    }
    if (schedule().weighted()) {
        masked_.resize(setup_.shape.sites());
        mask(schedule(), stats().slots, setup_.shape, frame, masked_);
        frame = masked_;
    }
    return frame;
}

std::span<const SamplePacket> Emulator::expose(std::span<const float> frame) {
    sensor_.expose(light_on_pixels(frame), packets_[0]);
    return readout_cost_ ? split_at_overrun(readout_cost_->add_next())
                         : std::span(packets_).first(1);
}

std::span<const SamplePacket> Emulator::expose(std::span<const float> frame, const SlotCost& slot) {
    sensor_.expose(light_on_pixels(frame), packets_[0]);
    return split_at_overrun(slot);
}

const SamplePacket& Emulator::expose_unread(std::span<const float> frame) {
    const std::int64_t slot = stats().slots;
    sensor_.expose_unread(light_on_pixels(frame));
    if (readout_cost_) readout_cost_->add_next();
    ++unread_[kind_of_slot(schedule(), slot)];
    packets_[0] = {slot, 0, setup_.shape.rows, SamplePacket::kDropped, {}};
    return packets_[0];
}

double Emulator::light_throughput() const {
    if (switched()) return std::numeric_limits<double>::quiet_NaN();
    return stipple::light_throughput(setup_.schedule.schedule, filters_, setup_.shape);
}

double Emulator::light_read() const {
    if (switched()) return std::numeric_limits<double>::quiet_NaN();
    const ExposureSchedule& schedule = setup_.schedule.schedule;
    const FrameShape& shape = setup_.shape;
    double light = light_due_in_clip(schedule, filters_, shape, stats().slots) - dropped_light_;
    for (const auto& [slot, times] : unread_)
        light -= times * light_due(schedule, filters_, {slot, 0, shape.rows, shape.cols});
    return light /
           (static_cast<double>(stats().slots) * static_cast<double>(setup_.shape.pixels()));
}

std::span<const SamplePacket> Emulator::split_at_overrun(const SlotCost& slot) {
    SamplePacket& whole = packets_[0];
    if (slot.end_row == whole.rows) {
        whole.flags = slot.overrun ? SamplePacket::kOverrun : 0;
        return std::span(packets_).first(1);
    }
    packets_[1] = {whole.slot, slot.end_row, whole.rows - slot.end_row, SamplePacket::kDropped, {}};
    dropped_light_ += light_due(setup_.schedule.schedule, filters_,
                                {whole.slot, slot.end_row, whole.rows, setup_.shape.cols});
    whole.rows = slot.end_row;
    whole.dn.resize(slot.counts.samples);
    return std::span(packets_).subspan(whole.rows > 0 ? 0 : 1);
}

std::string no_switch_text(const SensorSetup& setup) {
    if (setup.timing && setup.overrun == OverrunPolicy::kDrop)
        return "the sensor drops late rows; with the policy stretch it can";
    const ExposureSchedule& schedule = setup.schedule.schedule;
    if (schedule.weighted() || schedule.interleaved())
        return fmt::format("the schedule {} has weights or interleaved exposures",
                           setup.schedule.name);
    return {};
}

void check_switch(const SensorSetup& from, const SensorSetup& to, std::int64_t slot) {
    const auto refuse = [&](std::string_view why) {
        throw InputError(fmt::format("switch at slot {}", slot), why);
    };
    for (const SensorSetup* setup : {&from, &to})
        if (const std::string text = no_switch_text(*setup); !text.empty()) refuse(text);
    SensorParams same = to.params;
    same.rounding = from.params.rounding;
    same.full_scale_e = from.params.full_scale_e;
    same.full_well_e = from.params.full_well_e;
    same.read_noise_e = from.params.read_noise_e;
    same.photons_per_unit = from.params.photons_per_unit;
    same.physical.black_level_dn = from.params.physical.black_level_dn;
    if (same != from.params || from.shape != to.shape || from.footage != to.footage ||
        from.timing != to.timing)
        refuse(
            "only schedule, seed, rounding, full_scale_e, full_well_e, read_noise_e, "
            "photons_per_unit and black_level_dn may change");
}

ScheduleSwitch switch_of(const SensorSetup& to) {
    return {.schedule = to.schedule.schedule,
            .source = to.schedule.source,
            .name = to.schedule.name,
            .values = readout_values(calibration_of(to.params))};
}

std::int64_t lead_in_slots(const SensorSetup& setup) {
    const PhysicalTerms none;
    const PhysicalTerms& terms =
        setup.params.mode == SensorMode::kPhysical ? setup.params.physical : none;
    const auto refuse = [&](const char* key, double value) {
        if (value == 0) return;
        throw InputError(fmt::format("sensor {}", setup.params.name),
                         fmt::format("has {} = {}, by which each slot depends on all before it; "
                                     "emulate it in one run, or set sensor.{}=0",
                                     key, value, key));
    };
    refuse("lag", terms.lag);
    refuse("blooming", terms.blooming);
    const ExposureSchedule& schedule = setup.schedule.schedule;
    const std::int64_t span = std::max(schedule.longest_span_slots(), 1);
    // Row skew mixes the frame before into each frame.
    const std::int64_t skew = terms.row_skew_slots == 0 ? 0 : 1;
    if (terms.parasitic_light_sensitivity == 0) return span - 1 + skew;
    // A closed store collects light since it was last read: a period ago at most, and two where
    // the exposures of a pixel alternate between two stores.
    return std::int64_t{schedule.period_slots()} * schedule.charge_stores() + span + skew;
}

}  // namespace stipple
