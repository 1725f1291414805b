// A schedule of one's own on the scene `pan`: own_schedule OUT.stipple
#include <stipple/emulate.h>
#include <stipple/scene.h>

#include <iostream>
#include <vector>

/// A tile of 1 x 2 pixels and 4 slots: the left pixel reads each slot, the right one exposes 1
/// slot, then 3.
stipple::NamedSchedule fast_and_slow() {
    using stipple::open_without_gap;
    std::vector<stipple::Exposure> exposures;
    for (std::uint32_t slot = 0; slot < 4; ++slot) exposures.push_back({slot, open_without_gap(1)});
    exposures.push_back({0, open_without_gap(1)});
    exposures.push_back({1, open_without_gap(3)});
    return {"fast_and_slow", {}, stipple::ExposureSchedule(1, 2, 4, {0, 4, 6}, exposures)};
}

int main(int argc, char** argv) try {
    if (argc != 2) throw std::invalid_argument("usage: own_schedule OUT.stipple");
    const stipple::Scene scene(stipple::SceneName::kPan,
                               {.slots = 16, .shape = {.rows = 48, .cols = 64}});
    auto sensor = stipple::set_up_sensor({.sensor = "ideal"}, scene.options().shape);
    sensor.schedule = fast_and_slow();

    stipple::StreamRecorder recorder(
        argv[1], sensor,
        {.force = true, .provenance = stipple::provenance_of(sensor, {.name = "pan"})});
    std::vector<float> frame(scene.options().shape.sites());
    for (int slot = 0; slot < 16; ++slot) {
        scene.render(slot, frame);
        recorder.expose(frame);
    }
    recorder.finish();
    std::cout << recorder.samples() << " samples, light throughput "
              << recorder.emulator().light_throughput() << "\n";
} catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
}
