// Slots/s (items_per_second) of the emulated chip: 640x480 RGB, schedule `random`, the paper's
// sensor with all noise, footage in memory (a synthetic scene), the packet filled. The argument is
// the number of threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "core/flux_video.h"
#include "core/parallel.h"
#include "readout/coded_sensor.h"
#include "readout/column_adc.h"
#include "readout/schedules/tiled_schedule.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 480, .cols = 640, .planes = 3};

const FluxVideo& footage() {
    static const FluxVideo video = [] {
        FluxVideo rendered(8, kShape);
        const Scene scene(SceneName::kPan,
                          {.slots = rendered.slots(), .shape = kShape, .time_samples = 1});
        scene.render(0, rendered.frame(0));
        for (int slot = 1; slot < rendered.slots(); ++slot)  // other memory, the same light
            std::ranges::copy(rendered.frame(0), rendered.frame(slot).begin());
        return rendered;
    }();
    return video;
}

void expose_slots(benchmark::State& state, const ExposureSchedule& schedule) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const FluxVideo& video = footage();
    CodedSensor sensor({}, kShape, schedule, 1);
    SamplePacket packet;
    const auto next = [&] {
        sensor.expose(video.frame(static_cast<int>(sensor.stats().slots % video.slots())), packet);
    };
    for (int slot = 0; slot < 2 * schedule.period_slots(); ++slot) next();  // past the start
    for (auto step : state) {
        next();
        benchmark::DoNotOptimize(packet.dn.data());
    }
    state.SetItemsProcessed(state.iterations());
}

void random_slots(benchmark::State& state) {
    expose_slots(state, random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1));
}
void tiled_slots(benchmark::State& state) {
    expose_slots(state, tiled_schedule(16, 16, kPaperExposureSlots, 1));
}
void full1x_slots(benchmark::State& state) {
    expose_slots(state, full_schedule(1, 4));
}

/// Slots whose samples are dropped.
void unread_slots(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const ExposureSchedule schedule =
        random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    CodedSensor sensor({}, kShape, schedule, 1);
    for (auto step : state) sensor.expose_unread(footage().frame(0));
    state.SetItemsProcessed(state.iterations());
}

/// Msamples/s of the converter alone, one thread.
void adc_samples(benchmark::State& state) {
    std::vector<float> electrons(1U << 14U);
    for (std::size_t i = 0; i < electrons.size(); ++i)
        electrons[i] = static_cast<float>(i % 2500) - 100;
    std::vector<std::uint16_t> dn(electrons.size());
    const ColumnAdc adc{SensorParams{}};
    for (auto step : state) {
        adc.convert(electrons, dn);
        benchmark::DoNotOptimize(dn.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(dn.size()));
}

BENCHMARK(random_slots)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(unread_slots)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(tiled_slots)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(full1x_slots)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(adc_samples);

}  // namespace
}  // namespace stipple
