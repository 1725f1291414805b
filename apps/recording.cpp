#include "apps/recording.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/account_text.h"
#include "apps/number_text.h"

namespace stipple {
Recording::Recording(const std::filesystem::path& file, bool force, const SensorSetup& setup,
                     const std::string& footage)
    : output_(file, force),
      emulator_(setup),
      writer_(output_.partial(), stream_header_of(setup, footage), output_.final_path().string()) {}

std::span<const SamplePacket> Recording::expose(std::span<const float> frame) {
    const auto packets = emulator_.expose(frame);
    for (const SamplePacket& packet : packets) writer_.write(packet);
    return packets;
}

void Recording::finish() {
    writer_.finish();
    output_.commit();
}

std::uint64_t Recording::samples() const {
    return stats().samples - (account() ? account()->totals().dropped_samples : 0);
}

std::uint64_t Recording::payload_bits() const {
    return samples() * static_cast<std::uint64_t>(setup().params.bit_depth);
}

double Recording::compression_ratio() const {
    const double light_values =
        static_cast<double>(stats().slots) * static_cast<double>(setup().shape.sites());
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
    const std::string per_sample =
        fmt::format(", 1 for {:.2f} values of light", recording.compression_ratio());
    const std::string saturated =
        fmt::format(", {:.2f} % of the samples saturated", 100 * recording.saturated_fraction());
    const bool any = stats.samples > 0;
    std::string text = fmt::format(
        "{} of {} x {} x {}, {} of {} bits{}\n"
        "light throughput {:.1f} %{}, {} slots/s",
        counted(stats.slots, "slot"), setup.shape.cols, setup.shape.rows, setup.shape.planes,
        counted(recording.samples(), "sample"), setup.params.bit_depth,
        any ? per_sample : ": no exposure ended within the footage",
        100 * setup.schedule.schedule.light_throughput(), any ? saturated : "",
        rounded(static_cast<double>(stats.slots) / seconds));
    if (const ReadoutAccount* account = recording.account())
        text.append(1, '\n').append(account_text(*account));
    return text;
}

}  // namespace stipple
