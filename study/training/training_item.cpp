#include "study/training/training_item.h"

#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "readout/emulator.h"

namespace stipple {

ForwardModel samples_of_light(const SensorSetup& setup, std::uint64_t seed,
                              std::span<const float> light) {
    SensorSetup seeded = setup;
    seeded.seed = seed;
    seeded.timing.reset();
    std::optional<ForwardModel> model;
    run_on_this_thread([&] {
        Emulator emulator(seeded);
        std::vector<SamplePacket> packets;
        const std::size_t sites = seeded.footage.sites();
        for (std::size_t at = 0; at < light.size(); at += sites)
            packets.push_back(emulator.expose(light.subspan(at, sites)).front());
        const StreamHeader header = stream_header_of(seeded, "");
        model.emplace(collect_measurements(header, packets,
                                           {.slots = static_cast<int>(packets.size()),
                                            .shape = decoded_shape(header)}),
                      header.calibration);
    });
    return std::move(*model);
}

}  // namespace stipple
