#include "apps/recording.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/account_text.h"
#include "sensor_model/colour_mosaic.h"

namespace stipple {
namespace {

StreamHeader header_of(const SensorSetup& setup, const std::string& footage) {
    return {.shape = setup.shape,
            .slot_us = setup.params.slot_us,
            .calibration = calibration_of(setup.params),
            .schedule = setup.schedule.schedule,
            .schedule_source = setup.schedule.source,
            .schedule_name = setup.schedule.name,
            .provenance = provenance_of(setup, footage),
            .cfa = setup.params.physical.cfa};
}

}  // namespace

Recording::Recording(const std::filesystem::path& file, bool force, const SensorSetup& setup,
                     const std::string& footage)
    : setup_(setup),
      output_(file, force),
      sensor_(setup.params, setup.shape, setup.schedule.schedule, setup.seed),
      writer_(output_.partial(), header_of(setup, footage), output_.final_path().string()) {
    if (!setup.timing) return;
    const SlotBudget budget{slot_clocks(*setup.timing, setup.params.slot_us), setup.overrun};
    account_.emplace(*setup.timing, setup.schedule.schedule, setup.shape, budget);
}

void Recording::expose(std::span<const float> frame) {
    const ColourFilter filter = setup_.params.physical.cfa;
    if (filter != ColourFilter::kNone) {
        mosaic_.resize(setup_.shape.pixels());
        take_mosaic(filter, setup_.footage, frame, mosaic_);
        frame = mosaic_;
    }
    sensor_.expose(frame, packet_);
    account_ ? write_what_fits(account_->add_next()) : writer_.write(packet_);
}

void Recording::write_what_fits(const SlotAccount& slot) {
    if (slot.end_row == packet_.rows) {
        packet_.flags = slot.overrun ? SamplePacket::kOverrun : 0;
        writer_.write(packet_);
        return;
    }
    const SamplePacket dropped{
        packet_.slot, slot.end_row, packet_.rows - slot.end_row, SamplePacket::kDropped, {}};
    packet_.rows = slot.end_row;
    packet_.dn.resize(slot.counts.samples);
    if (packet_.rows > 0) writer_.write(packet_);
    writer_.write(dropped);
}

void Recording::finish() {
    writer_.finish();
    output_.commit();
}

std::uint64_t Recording::samples() const {
    return stats().samples - (account_ ? account_->totals().dropped_samples : 0);
}

std::uint64_t Recording::payload_bits() const {
    return samples() * static_cast<std::uint64_t>(setup_.params.bit_depth);
}

double Recording::compression_ratio() const {
    const double light_values =
        static_cast<double>(stats().slots) * static_cast<double>(setup_.shape.sites());
    return light_values / static_cast<double>(samples());
}

double Recording::saturated_fraction() const {
    return static_cast<double>(stats().saturated_samples) / static_cast<double>(stats().samples);
}

nlohmann::ordered_json recording_json(const Recording& recording, double seconds) {
    const ReadoutStats& stats = recording.stats();
    nlohmann::ordered_json json{
        {"slots", stats.slots},
        {"samples", recording.samples()},
        {"payload_bits", recording.payload_bits()},
        {"compression_ratio", recording.compression_ratio()},
        {"light_throughput", recording.setup().schedule.schedule.light_throughput()},
        {"saturated_fraction", recording.saturated_fraction()},
        {"slots_per_second", static_cast<double>(stats.slots) / seconds},
        {"samples_per_second", static_cast<double>(stats.samples) / seconds}};
    if (const ReadoutAccount* account = recording.account())
        json["readout"] = account_json(*account);
    return json;
}

std::string recording_text(const Recording& recording, double seconds) {
    const SensorSetup& setup = recording.setup();
    const ReadoutStats& stats = recording.stats();
    std::string text = fmt::format(
        "{} slots of {} x {} x {}, {} samples of {} bits, 1 for {:.2f} values of light\n"
        "light throughput {:.1f} %, {:.2f} % of the samples saturated, {:.3g} slots/s",
        stats.slots, setup.shape.cols, setup.shape.rows, setup.shape.planes, recording.samples(),
        setup.params.bit_depth, recording.compression_ratio(),
        100 * setup.schedule.schedule.light_throughput(), 100 * recording.saturated_fraction(),
        static_cast<double>(stats.slots) / seconds);
    if (const ReadoutAccount* account = recording.account())
        text.append(1, '\n').append(account_text(*account));
    return text;
}

}  // namespace stipple
