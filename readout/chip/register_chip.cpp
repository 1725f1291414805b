#include "readout/chip/register_chip.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "core/error.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "readout/emulator.h"
#include "readout/program/sequencer_program.h"
#include "readout/schedule_feasibility.h"

namespace stipple {
namespace {

constexpr std::uint32_t kId = 0x53504C31;

std::uint32_t word(int value) {
    return static_cast<std::uint32_t>(value);
}

std::uint32_t of_bank(std::uint32_t address, int bank) {
    return address + 4 * word(bank);
}

/// NAME-2.stipple for the second capture.
std::filesystem::path numbered(const std::filesystem::path& output, std::size_t number) {
    if (number == 1) return output;
    std::filesystem::path file = output;
    file.replace_filename(
        fmt::format("{}-{}{}", output.stem().string(), number, output.extension().string()));
    return file;
}

}  // namespace

RegisterChip::RegisterChip(SensorSetup setup, const ChipGeometry& geometry, ChipFiles files)
    : setup_(std::move(setup)),
      geometry_((check_geometry(geometry), geometry)),
      files_(std::move(files)),
      banks_(geometry) {
    for (const ChipRegister& it : chip_registers())
        for (std::uint32_t i = 0; i < it.count; ++i) values_[it.address + 4 * i] = it.reset;
    values_[STIPPLE_ID] = kId;
    values_[STIPPLE_ARRAY_ROWS] = word(geometry.rows);
    values_[STIPPLE_ARRAY_COLS] = word(geometry.cols);
    values_[STIPPLE_TILE_ROWS] = word(geometry.tile_rows);
    values_[STIPPLE_TILE_COLS] = word(geometry.tile_cols);
    values_[STIPPLE_DEPTH] = word(geometry.depth);
    values_[STIPPLE_PIXEL_BITS] = word(geometry.pixel_bits);
    values_[STIPPLE_CHANNELS] = word(geometry.addressing.channels);
    values_[STIPPLE_BIT_DEPTH] = word(geometry.bit_depth);
    values_[STIPPLE_DARK_ROWS_MAX] = word(geometry.dark_rows_max);
}

void RegisterChip::preset() {
    if (const auto why = store_problem(setup_.schedule.schedule, setup_.params.charge_stores))
        throw InputError("schedule " + setup_.schedule.name, *why);
    const SequencerProgram program = compile_schedule(setup_.schedule.schedule);
    banks_.load(0, program);
    const SlotBudget budget{slot_clocks(*setup_.timing, setup_.params.slot_us), setup_.overrun};
    for (const auto& [address, value] : register_values(*setup_.timing, setup_.shape, budget))
        values_[address] = value;
    values_[STIPPLE_BANK_PERIOD] = word(program.period_slots);
}

std::string RegisterChip::read_problem(std::uint32_t address) const {
    return register_at(address) == nullptr ? fmt::format("0x{:03X} is not a register", address)
                                           : "";
}

bool RegisterChip::is_locked(int bank) const {
    return capture_ && (active_ == bank || capture_->is_swap_pending());
}

std::string RegisterChip::write_problem(std::uint32_t address, std::uint32_t value) const {
    const ChipRegister* const it = register_at(address);
    if (it == nullptr) return read_problem(address);
    const std::string name = register_name(address);
    if (it->access == ChipRegister::Access::kRead) return name + " is read-only";
    if (std::uint64_t{value} >> static_cast<unsigned>(it->bits) != 0)
        return fmt::format("{} has {} bits, at most {}", name, it->bits,
                           (std::uint64_t{1} << static_cast<unsigned>(it->bits)) - 1);
    if (it->lock == ChipRegister::Lock::kRun && capture_)
        return name + " is locked while a capture runs";
    const int bank = address == STIPPLE_MEMORY_DATA ? banks_.bank()
                                                    : static_cast<int>(address - it->address) / 4;
    if (it->lock == ChipRegister::Lock::kBank && is_locked(bank))
        return fmt::format("{} of bank {} is locked while a capture runs from it or a swap waits",
                           name, bank);
    if (address == STIPPLE_MEMORY_DATA && banks_.is_beyond())
        return fmt::format("{}: a bank has {} words", name, geometry_.depth * geometry_.tile_rows);
    return {};
}

std::uint32_t RegisterChip::status() const {
    std::uint32_t bits = active_ == 1 ? std::uint32_t{STIPPLE_STATUS_BANK} : 0U;
    if (!capture_) return bits;
    bits |= STIPPLE_STATUS_RUNNING;
    if (capture_->is_exposing()) bits |= STIPPLE_STATUS_EXPOSING;
    if (capture_->is_swap_pending()) bits |= STIPPLE_STATUS_SWAP_PENDING;
    return bits;
}

std::uint32_t RegisterChip::value_of(std::uint32_t address) const {
    switch (address) {
        case STIPPLE_STATUS:
            return status();
        case STIPPLE_ERROR:
            return errors_;
        case STIPPLE_SLOT_COUNT:
            return counters_.slots;
        case STIPPLE_OVERRUN_COUNT:
            return counters_.overruns;
        case STIPPLE_DROPPED_COUNT:
            return counters_.dropped;
        case STIPPLE_PACKET_COUNT:
            return counters_.packets;
        case STIPPLE_SAMPLE_COUNT:
            return counters_.samples;
        case STIPPLE_SWAP_SLOT:
            return counters_.swap_slot;
        default:
            return values_.at(address);
    }
}

void RegisterChip::note(std::string_view why) {
    if (!problem_.empty()) problem_ += "; ";
    problem_ += why;
}

void RegisterChip::refuse(std::string_view why) {
    errors_ |= STIPPLE_ERROR_SETUP;
    note(why);
}

/// Up to the state that this clock sees.
void RegisterChip::advance(std::int64_t clock) {
    if (!capture_) return;
    capture_->advance(clock);
    counters_ = capture_->counters();
    if (capture_->take_swapped()) active_ = 1 - active_;
    if (capture_->has_no_time()) errors_ |= STIPPLE_ERROR_NO_TIME;
    if (const std::string problem = capture_->take_problem(); !problem.empty()) refuse(problem);
    if (!capture_->has_ended()) return;
    if (counters_.slots == 0) outputs_.pop_back();
    capture_.reset();
}

std::optional<std::uint32_t> RegisterChip::read(std::uint32_t address) {
    advance(now_);
    now_ += 2;
    const std::string problem = read_problem(address);
    if (problem.empty()) return value_of(address);
    errors_ |= STIPPLE_ERROR_ACCESS;
    note(problem);
    return std::nullopt;
}

bool RegisterChip::write(std::uint32_t address, std::uint32_t value) {
    advance(now_);
    const std::string problem = write_problem(address, value);
    const bool was_running = capture_ != nullptr;
    advance(now_ + 1);
    if (!problem.empty()) {
        errors_ |= STIPPLE_ERROR_ACCESS;
        note(problem);
    } else if (address == STIPPLE_CONTROL) {
        command(value, was_running);
    } else {
        store(address, value);
    }
    now_ += 2;
    return problem.empty();
}

void RegisterChip::wait(std::int64_t clocks) {
    now_ += clocks;
    advance(now_);
}

void RegisterChip::finish() {
    if (!capture_) return;
    capture_->stop();
    advance(std::numeric_limits<std::int64_t>::max());
}

void RegisterChip::store(std::uint32_t address, std::uint32_t value) {
    if (address == STIPPLE_ERROR)
        errors_ &= ~value;
    else if (address == STIPPLE_MEMORY_ADDRESS)
        banks_.set_address(value);
    else if (address == STIPPLE_MEMORY_DATA)
        banks_.write(value);
    else
        values_[address] = value;
}

void RegisterChip::command(std::uint32_t bits, bool was_running) {
    const bool starts = (bits & STIPPLE_CONTROL_START) != 0;
    const bool swaps = (bits & STIPPLE_CONTROL_SWAP) != 0;
    if (!was_running) {
        if (swaps) active_ = 1 - active_;
        if (starts) start();
        return;
    }
    if (starts) refuse("START: a capture runs");
    if (!capture_) return;
    if ((bits & STIPPLE_CONTROL_STOP) != 0) capture_->stop();
    if (swaps) swap();
}

/// Tables of a bank are filled in so many clocks.
std::int64_t RegisterChip::fill_clocks(int bank) const {
    return (std::int64_t{3} * geometry_.tile_rows + std::int64_t{2} * values_.at(STIPPLE_ROWS)) *
           values_.at(of_bank(STIPPLE_BANK_PERIOD, bank));
}

/// The schedule of a bank that becomes active in slot `swap_slot`.
NamedSchedule RegisterChip::schedule_of_bank(int bank, std::int64_t swap_slot) const {
    const std::uint32_t period_at = of_bank(STIPPLE_BANK_PERIOD, bank);
    const std::uint32_t offset_at = of_bank(STIPPLE_BANK_OFFSET, bank);
    const auto period = static_cast<int>(values_.at(period_at));
    const auto offset = static_cast<int>(values_.at(offset_at));
    if (period < 1 || period > geometry_.depth)
        throw InputError(register_name(period_at),
                         fmt::format("{} is not 1 to {}", period, geometry_.depth));
    if (offset >= period)
        throw InputError(register_name(offset_at),
                         fmt::format("{} is not less than the period, {}", offset, period));
    const auto first = static_cast<int>((offset - swap_slot % period + period) % period);
    const ExposureSchedule schedule = banks_.schedule(bank, period, first);
    if (schedule == setup_.schedule.schedule) return setup_.schedule;
    return {.name = fmt::format("bank {}", bank), .source = {}, .schedule = schedule};
}

CapturePlan RegisterChip::plan() const {
    CapturePlan plan{
        .settings = capture_settings(values_, geometry_), .setup = setup_, .light = setup_.footage};
    const FrameShape& window = plan.settings.window;
    SensorSetup& setup = plan.setup;
    if (window.rows > setup.shape.rows || window.cols > setup.shape.cols)
        throw InputError("footage",
                         fmt::format("has {} x {} pixels (width x height), less than "
                                     "the region of {} x {}, COLS x ROWS",
                                     setup.shape.cols, setup.shape.rows, window.cols, window.rows));
    setup.shape.rows = setup.footage.rows = window.rows;
    setup.shape.cols = setup.footage.cols = window.cols;
    setup.overrun = plan.settings.slot.policy;
    setup.schedule = schedule_of_bank(active_, 0);
    setup.timing.reset();
    if (const auto why = store_problem(setup.schedule.schedule, setup.params.charge_stores))
        throw InputError(fmt::format("bank {}", active_), *why);
    const std::int64_t clocks =
        plan.settings.budget_clocks > 0 ? plan.settings.budget_clocks : plan.settings.slot.clocks;
    if (clocks != slot_clocks(*setup_.timing, setup.params.slot_us))
        setup.params.slot_us =
            static_cast<double>(clocks) * 1e6 / static_cast<double>(setup_.timing->clock_hz);
    // What late rows allow (\throws InputError).
    static_cast<void>(
        ReadoutCost(plan.settings.timing, setup.schedule.schedule, window, plan.settings.slot));
    return plan;
}

/// A command makes the stream again if the registers are those of the sensor file.
std::string RegisterChip::provenance(const CapturePlan& plan) const {
    SensorSetup named = plan.setup;
    const SlotBudget budget{slot_clocks(*setup_.timing, setup_.params.slot_us), named.overrun};
    bool is_sensor = named.footage == setup_.footage;
    for (const auto& [address, value] :
         register_values(*setup_.timing, plan.settings.window, budget))
        is_sensor = is_sensor && values_.at(address) == value;
    if (is_sensor)
        named.timing = setup_.timing;
    else
        named.origin.reset();
    return provenance_of(named, files_.footage);
}

void RegisterChip::start() {
    std::optional<CapturePlan> planned;
    try {
        planned = plan();
    } catch (const InputError& e) {
        return refuse(fmt::format("START: {}", e.what()));
    }
    const bool may_switch = planned->settings.slots != 1 &&
                            no_switch_text(planned->setup).empty() &&
                            planned->settings.slot.policy == OverrunPolicy::kStretch;
    const std::filesystem::path file = numbered(files_.output, outputs_.size() + 1);
    const StreamRecorderOptions options{
        .force = files_.force, .may_switch = may_switch, .provenance = provenance(*planned)};
    capture_ =
        std::make_unique<RunningCapture>(std::move(*planned), options, file, files_.open_light);
    capture_->begin_at(now_ + 2 + fill_clocks(active_));
    outputs_.push_back(file);
    counters_ = {};
}

void RegisterChip::swap() {
    const int other = 1 - active_;
    const auto schedule_from = [this, other](std::int64_t slot) {
        SensorSetup setup = capture_->setup();
        setup.schedule = schedule_of_bank(other, slot);
        return setup;
    };
    if (capture_->is_swap_pending()) return refuse("SWAP: a swap waits already");
    if (capture_->settings().slot.policy == OverrunPolicy::kDrop)
        return refuse("SWAP: late rows are dropped; set DROPS to 0");
    try {
        check_switch(capture_->setup(), schedule_from(1), 1);
    } catch (const InputError& e) {
        return refuse(fmt::format("SWAP: {}", e.what()));
    }
    capture_->swap(now_, fill_clocks(other), schedule_from);
}

}  // namespace stipple
