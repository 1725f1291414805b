// Voxels/s (items_per_second) of the decoder on a synthetic scene, 256x256x32, schedule `random`,
// samples in memory. `copy` moves one float a voxel: the peer of the same run that other machines'
// figures can be compared by. The argument is the number of threads.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "core/parallel.h"
#include "decoder/fast/motion_tv.h"
#include "decoder/forward_model.h"
#include "decoder/live/live_decoder.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/pixel_response.h"
#include "readout/coded_sensor.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

constexpr int kSlots = 32;

FrameShape shape_of(int planes) {
    return {.rows = 256, .cols = 256, .planes = planes};
}

/// The samples of scene `pan`.
Measurements record(int planes) {
    const FrameShape shape = shape_of(planes);
    const Scene scene(SceneName::kPan, {.slots = kSlots, .shape = shape, .time_samples = 1});
    const StreamHeader header{.shape = shape,
                              .slot_us = 5000,
                              .calibration = calibration_of({}),
                              .schedule = random_schedule(256, 256, kPaperExposureSlots, 1),
                              .schedule_source = {},
                              .schedule_name = "random",
                              .provenance = ""};
    CodedSensor sensor({}, shape, header.schedule, 1);
    std::vector<SamplePacket> packets(kSlots);
    std::vector<float> frame(shape.sites());
    for (int slot = 0; slot < kSlots; ++slot) {
        scene.render(slot, frame);
        sensor.expose(frame, packets[static_cast<std::size_t>(slot)]);
    }
    return collect_measurements(header, packets, {0, kSlots, 0, 0, shape});
}

const Measurements& measurements(int planes) {
    if (planes == 1) {
        static const Measurements mono = record(1);
        return mono;
    }
    static const Measurements colour = record(3);
    return colour;
}

void count_voxels(benchmark::State& state, int planes) {
    state.SetItemsProcessed(state.iterations() * kSlots *
                            static_cast<std::int64_t>(shape_of(planes).sites()));
}

void fast(benchmark::State& state, int planes) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    measurements(planes);  // recorded before the clock starts
    for (auto step : state) {
        Measurements m = measurements(planes);
        auto x = decode_motion_tv(m, SampleNoise(Calibration{}), {});
        benchmark::DoNotOptimize(x);
    }
    count_voxels(state, planes);
}

void motion(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const FluxVideo x = nearest_samples(measurements(1));
    for (auto step : state) benchmark::DoNotOptimize(estimate_motion(x, {}));
    count_voxels(state, 1);
}

/// One iteration of total variation along motion.
void iteration(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    FluxVideo x = nearest_samples(measurements(1));
    const auto fields = estimate_motion(x, {});
    const std::vector<float> step(x.voxels(), 0.005F);
    TotalVariationSolver solver(measurements(1));
    for (auto run : state) solver.minimise(fields, step, {.iterations = 10}, x);
    state.SetItemsProcessed(10 * state.iterations() * static_cast<std::int64_t>(x.voxels()));
}

void naive(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const Measurements& m = measurements(1);
    for (auto step : state) benchmark::DoNotOptimize(nearest_samples(m));
    count_voxels(state, 1);
}

void live(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const Measurements& m = measurements(1);
    for (auto step : state) benchmark::DoNotOptimize(decode_live(m));
    count_voxels(state, 1);
}

/// An operation of the forward model, on the light `x` of the naive decoder.
template <typename Operation>
void operate(benchmark::State& state, const Operation& operation) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const ForwardModel model(measurements(1), Calibration{});
    const FluxVideo x = nearest_samples(measurements(1));
    FluxVideo result = x;
    for (auto step : state) {
        operation(model, x.data(), result.data());
        benchmark::DoNotOptimize(result);
    }
    count_voxels(state, 1);
}

void forward(benchmark::State& state) {
    operate(state, [](const ForwardModel& model, auto x, auto y) { model.forward(x, y); });
}
void adjoint(benchmark::State& state) {
    operate(state, [](const ForwardModel& model, auto x, auto y) { model.adjoint(x, y); });
}
void prox(benchmark::State& state) {
    const std::vector<float> steps(measurements(1).voxels(), 0.005F);
    operate(state, [&](const ForwardModel& model, auto x, auto v) {
        std::ranges::copy(x, v.begin());
        model.prox(steps, v);
    });
}

void copy(benchmark::State& state) {
    const FluxVideo x(kSlots, shape_of(1));
    FluxVideo y = x;
    for (auto step : state) {
        std::ranges::copy(x.data(), y.data().begin());
        benchmark::DoNotOptimize(y);
    }
    count_voxels(state, 1);
}

void fast_mono(benchmark::State& state) {
    fast(state, 1);
}
void fast_colour(benchmark::State& state) {
    fast(state, 3);
}

BENCHMARK(fast_mono)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(fast_colour)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(motion)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(iteration)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(naive)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(live)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(forward)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(adjoint)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(prox)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(copy);

}  // namespace
}  // namespace stipple
