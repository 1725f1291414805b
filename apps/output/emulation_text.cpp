#include "apps/output/emulation_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/output/text_layout.h"
#include "readout/emulation_figures.h"
#include "readout/sensor_file.h"
#include "study/report/json_figures.h"

namespace stipple {

nlohmann::ordered_json emulation_json(const StreamRecorder& recorder,
                                      std::optional<double> slots_per_second) {
    auto json = json_of([&](const auto& add) {
        visit_emulation_figures(recorder, add);
        visit_speed_figures(recorder, slots_per_second, add);
    });
    if (const ReadoutCost* cost = recorder.emulator().readout_cost())
        json["readout"] = readout_json(*cost, recorder.emulator().light_throughput());
    return json;
}

std::string emulation_text(const StreamRecorder& recorder, std::optional<double> slots_per_second) {
    const SensorSetup& setup = recorder.emulator().setup();
    const ReadoutStats& stats = recorder.emulator().stats();
    const std::string per_sample =
        fmt::format(", 1 for {:.2f} values of light in this clip", recorder.compression_ratio());
    const std::string clipped =
        fmt::format(", {:.2f} % of the samples saturated, {:.2f} % at DN 0",
                    100 * recorder.saturated_fraction(), 100 * recorder.zero_fraction());
    const bool any = stats.samples > 0;
    const std::string light =
        recorder.emulator().switched()
            ? "the schedule has changed"
            : fmt::format("light throughput {:.1f} %, {:.1f} % read within the clip",
                          100 * recorder.emulator().light_throughput(),
                          100 * recorder.emulator().light_read());
    std::string text = fmt::format(
        "{} of {} x {} x {}, {} of {} bits{}\n{}{}{}", counted(stats.slots, "slot"),
        setup.shape.cols, setup.shape.rows, setup.shape.planes,
        counted(recorder.samples(), "sample"), setup.params.bit_depth,
        any ? per_sample : ": no exposure ended within the footage", light, any ? clipped : "",
        slots_per_second ? fmt::format(", {} slots/s", rounded(*slots_per_second)) : "");
    if (const ReadoutCost* cost = recorder.emulator().readout_cost())
        text.append(1, '\n').append(readout_text(*cost));
    return text;
}

}  // namespace stipple
