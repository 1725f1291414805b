#include "apps/recording.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/account_text.h"
#include "apps/leftovers.h"
#include "apps/number_text.h"
#include "readout/light_account.h"

namespace stipple {
Recording::Recording(const std::filesystem::path& file, bool force, const SensorSetup& setup,
                     const FootageOrigin& footage)
    : output_(file, force),
      emulator_(setup),
      writer_(output_.partial(), stream_header_of(setup, footage), output_.final_path().string()) {
    say_leftover(output_.final_path());
}

std::span<const SamplePacket> Recording::expose(std::span<const float> frame) {
    const auto packets = emulator_.expose(frame);
    for (const SamplePacket& packet : packets) writer_.write(packet);
    return packets;
}

void Recording::finish() {
    writer_.finish();
    output_.commit();
}

bool Recording::keep() {
    if (output_.kept()) return false;
    output_.commit();
    return true;
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

double Recording::light_throughput() const {
    return stipple::light_throughput(setup().schedule.schedule, emulator_.filters(), setup().shape);
}

nlohmann::ordered_json recording_json(const Recording& recording,
                                      std::optional<double> slots_per_s) {
    const ReadoutStats& stats = recording.stats();
    nlohmann::ordered_json json{{"slots", stats.slots},
                                {"samples", recording.samples()},
                                {"payload_bits", recording.payload_bits()},
                                {"compression_ratio", recording.compression_ratio()},
                                {"light_throughput", recording.light_throughput()},
                                {"light_read", recording.light_read()},
                                {"saturated_fraction", recording.saturated_fraction()},
                                {"slots_per_second", nullptr},
                                {"samples_per_second", nullptr}};
    if (slots_per_s) {
        json["slots_per_second"] = *slots_per_s;
        json["samples_per_second"] =
            *slots_per_s * static_cast<double>(stats.samples) / static_cast<double>(stats.slots);
    }
    if (const ReadoutAccount* account = recording.account())
        json["readout"] = account_json(*account, recording.light_throughput());
    return json;
}

std::string recording_text(const Recording& recording, std::optional<double> slots_per_s) {
    const SensorSetup& setup = recording.setup();
    const ReadoutStats& stats = recording.stats();
    const std::string per_sample =
        fmt::format(", 1 for {:.2f} values of light", recording.compression_ratio());
    const std::string saturated =
        fmt::format(", {:.2f} % of the samples saturated", 100 * recording.saturated_fraction());
    const bool any = stats.samples > 0;
    std::string text = fmt::format(
        "{} of {} x {} x {}, {} of {} bits{}\n"
        "light throughput {:.1f} %, {:.1f} % read within the clip{}{}",
        counted(stats.slots, "slot"), setup.shape.cols, setup.shape.rows, setup.shape.planes,
        counted(recording.samples(), "sample"), setup.params.bit_depth,
        any ? per_sample : ": no exposure ended within the footage",
        100 * recording.light_throughput(), 100 * recording.light_read(), any ? saturated : "",
        slots_per_s ? fmt::format(", {} slots/s", rounded(*slots_per_s)) : "");
    if (const ReadoutAccount* account = recording.account())
        text.append(1, '\n').append(account_text(*account));
    return text;
}

}  // namespace stipple
