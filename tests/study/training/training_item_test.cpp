#include "study/training/training_item.h"

#include <gtest/gtest.h>

#include <vector>

#include "decoder/measurements.h"
#include "readout/emulator.h"

namespace stipple {
namespace {

TEST(TrainingItemTest, HasTheSamplesOfTheEmulator) {
    const SensorSetup setup = set_up_sensor({.sensor = "lux1310", .schedule = "tiled", .seed = 3},
                                            {.rows = 20, .cols = 24});
    std::vector<float> light(18 * setup.footage.sites());
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = 0.1F * static_cast<float>(i % 97);

    SensorSetup seeded = setup;
    seeded.seed = 8;  // of the noise, not of the schedule
    Emulator emulator(seeded);
    std::vector<SamplePacket> packets;
    for (std::size_t slot = 0; slot < 18; ++slot)
        packets.push_back(emulator
                              .expose(std::span(light).subspan(slot * setup.footage.sites(),
                                                               setup.footage.sites()))
                              .front());
    const Measurements wanted = collect_measurements(stream_header_of(seeded, ""), packets,
                                                     {.slots = 18, .shape = setup.shape});
    const ForwardModel model = samples_of_light(setup, 8, light);
    EXPECT_EQ(model.measurements().state, wanted.state);
    EXPECT_EQ(model.measurements().variance, wanted.variance);
    EXPECT_NE(samples_of_light(setup, 9, light).measurements().sum, model.measurements().sum);
}

}  // namespace
}  // namespace stipple
