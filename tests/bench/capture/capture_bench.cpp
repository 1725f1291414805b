// One thread, frames of 640 x 480 pixels. `frames` is per second, bytes are those of the wire.
// record_mono16 writes to a file in the folder of temporary files.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <random>
#include <vector>

#include "capture/frame_light.h"
#include "capture/recording/recording_reader.h"
#include "capture/recording/recording_writer.h"

namespace stipple {
namespace {

constexpr int kCols = 640;
constexpr int kRows = 480;
constexpr std::size_t kFrames = 50;

CapturedFrame random_frame(const char* format) {
    CapturedFrame frame;
    FrameLayout& layout = frame.record.layout;
    layout.format = pixel_format_named(format);
    layout.width = kCols;
    layout.height = kRows;
    layout.stride_bytes = layout.format->row_bytes(kCols);
    frame.payload.resize(layout.payload_bytes());
    std::minstd_rand random(1);
    for (std::uint8_t& byte : frame.payload) byte = static_cast<std::uint8_t>(random() >> 8U);
    return frame;
}

void count(benchmark::State& state, const CapturedFrame& frame, std::size_t frames = 1) {
    const auto done = state.iterations() * static_cast<std::int64_t>(frames);
    state.SetBytesProcessed(done * static_cast<std::int64_t>(frame.payload.size()));
    state.counters["frames"] =
        benchmark::Counter(static_cast<double>(done), benchmark::Counter::kIsRate);
}

void unpack(benchmark::State& state, const char* format) {
    const CapturedFrame frame = random_frame(format);
    std::vector<std::uint16_t> samples;
    for (auto step : state) {
        unpack_frame(frame.record.layout, frame.payload, samples);
        benchmark::DoNotOptimize(samples.data());
        benchmark::ClobberMemory();
    }
    count(state, frame);
}
BENCHMARK_CAPTURE(unpack, Mono8, "Mono8");
BENCHMARK_CAPTURE(unpack, Mono16, "Mono16");
BENCHMARK_CAPTURE(unpack, Mono10p, "Mono10p");
BENCHMARK_CAPTURE(unpack, Mono12p, "Mono12p");
BENCHMARK_CAPTURE(unpack, Mono12Packed, "Mono12Packed");
BENCHMARK_CAPTURE(unpack, Mono10MIPI, "Mono10MIPI");
BENCHMARK_CAPTURE(unpack, RGB8, "RGB8");

void to_light(benchmark::State& state) {
    const CapturedFrame frame = random_frame("Mono16");
    FrameLight to_light(frame.record.layout, 0);
    std::vector<float> light(to_light.shape().sites());
    for (auto step : state) {
        to_light.convert(frame.payload, light);
        benchmark::DoNotOptimize(light.data());
        benchmark::ClobberMemory();
    }
    count(state, frame);
}
BENCHMARK(to_light);

std::filesystem::path file_name() {
    return std::filesystem::temp_directory_path() /
           ("bench_capture_" + std::to_string(std::random_device{}()) + ".strec");
}

void write_file(const std::filesystem::path& file, const CapturedFrame& frame) {
    RecordingWriter writer(file, {});
    for (std::size_t i = 0; i < kFrames; ++i) writer.write(frame);
    writer.finish({});
}

void record_mono16(benchmark::State& state) {
    const auto file = file_name();
    const CapturedFrame frame = random_frame("Mono16");
    for (auto step : state) write_file(file, frame);
    count(state, frame, kFrames);
    std::filesystem::remove(file);
}
BENCHMARK(record_mono16)->UseRealTime();

void read_mono16(benchmark::State& state) {
    const auto file = file_name();
    CapturedFrame frame = random_frame("Mono16");
    write_file(file, frame);
    for (auto step : state) {
        RecordingReader reader(file);
        while (reader.next(frame)) benchmark::DoNotOptimize(frame.payload.data());
    }
    count(state, frame, kFrames);
    std::filesystem::remove(file);
}
BENCHMARK(read_mono16)->UseRealTime();

}  // namespace
}  // namespace stipple
