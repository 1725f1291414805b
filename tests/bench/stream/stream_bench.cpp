// One thread. Samples per second are items_per_second; `of_memcpy` is that rate over the rate at
// which memcpy moves the same samples (16 bits each) in the same run. The argument of pack and
// unpack is the bit depth. write_vga and read_vga are whole slots: schedule check, CRC and file.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/philox.h"
#include "stream/bit_packing.h"
#include "stream/crc32c.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;

/// Samples of a 640 x 480 slot with the paper's schedule.
constexpr std::size_t kSamples = 81920;

std::vector<std::uint16_t> random_samples(int bit_depth) {
    std::vector<std::uint16_t> dn(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i)
        dn[i] = static_cast<std::uint16_t>(philox4x32({i, 0, 0, 0}, 1)[0] >> (32 - bit_depth));
    return dn;
}

void count_samples(benchmark::State& state, std::size_t samples) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples));
}

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

double seconds_of_memcpy() {
    constexpr int kRounds = 1000;
    const auto dn = random_samples(16);
    std::vector<std::uint16_t> result(kSamples);
    const auto begin = Clock::now();
    for (int round = 0; round < kRounds; ++round) {
        std::memcpy(result.data(), dn.data(), kSamples * sizeof(dn[0]));
        benchmark::DoNotOptimize(result.data());
        benchmark::ClobberMemory();
    }
    return seconds_since(begin) / kRounds;
}

template <typename Work>
void measure(benchmark::State& state, Work&& work) {
    const double copy_seconds = seconds_of_memcpy();
    const auto begin = Clock::now();
    for (auto step : state) {
        work();
        benchmark::ClobberMemory();
    }
    const double seconds = seconds_since(begin) / static_cast<double>(state.iterations());
    state.counters["of_memcpy"] = copy_seconds / seconds;
    count_samples(state, kSamples);
}

void pack(benchmark::State& state) {
    const auto bit_depth = static_cast<int>(state.range(0));
    const auto dn = random_samples(bit_depth);
    std::vector<std::uint8_t> packed(packed_bytes(kSamples, bit_depth));
    benchmark::DoNotOptimize(packed.data());
    measure(state, [&] { pack_bits(dn, bit_depth, packed); });
}

void unpack(benchmark::State& state) {
    const auto bit_depth = static_cast<int>(state.range(0));
    std::vector<std::uint16_t> dn = random_samples(bit_depth);
    std::vector<std::uint8_t> packed(packed_bytes(kSamples, bit_depth));
    pack_bits(dn, bit_depth, packed);
    benchmark::DoNotOptimize(dn.data());
    measure(state, [&] { unpack_bits(packed, bit_depth, dn); });
}

void crc(benchmark::State& state) {
    const std::vector<std::uint8_t> payload(kSamples, 0x5A);
    measure(state, [&] { benchmark::DoNotOptimize(crc32c(payload)); });
}

StreamHeader vga_header() {
    const std::vector<int> lengths(std::begin(kPaperExposureSlots), std::end(kPaperExposureSlots));
    return {{480, 640, 1},
            5000,
            {},
            random_schedule(480, 640, lengths, 1),
            {ScheduleSource::Kind::kRandom, lengths, 1},
            "random",
            ""};
}

std::vector<SamplePacket> vga_packets(const StreamHeader& header, int slots) {
    std::vector<SamplePacket> packets;
    for (std::int64_t slot = 0; slot < slots; ++slot)
        packets.push_back(
            {slot, 0, 480, 0,
             std::vector<std::uint16_t>(count_due(header.schedule, slot, 0, 480, 640), 200)});
    return packets;
}

std::filesystem::path scratch_file() {
    return std::filesystem::temp_directory_path() / "stipple_stream_bench.stipple";
}

/// Also says the share of the file that is not samples, header left out: below 0.5 %.
void write_vga(benchmark::State& state) {
    const StreamHeader header = vga_header();
    const auto packets = vga_packets(header, 100);
    std::size_t samples = 0;
    for (const SamplePacket& packet : packets) samples += packet.dn.size();
    for (auto step : state) {
        state.PauseTiming();  // the header: a random schedule is made anew
        StreamWriter writer(scratch_file(), header);
        state.ResumeTiming();
        const std::uint64_t begin = writer.bytes_written();
        for (const SamplePacket& packet : packets) writer.write(packet);
        writer.finish();
        const auto bytes = static_cast<double>(writer.bytes_written() - begin);
        state.counters["overhead_percent"] = 100 * (bytes / static_cast<double>(samples) - 1);
    }
    count_samples(state, samples);
    std::filesystem::remove(scratch_file());
}

void read_vga(benchmark::State& state) {
    const StreamHeader header = vga_header();
    {
        StreamWriter writer(scratch_file(), header);
        for (const SamplePacket& packet : vga_packets(header, 100)) writer.write(packet);
        writer.finish();
    }
    std::uint64_t samples = 0;
    for (auto step : state) {
        state.PauseTiming();
        StreamReader reader(scratch_file(), ReadPolicy::kStrict);
        state.ResumeTiming();
        for (SamplePacket packet; reader.next(packet);) benchmark::DoNotOptimize(packet.dn.data());
        samples = reader.report().samples;
    }
    count_samples(state, samples);
    std::filesystem::remove(scratch_file());
}

BENCHMARK(pack)->Arg(8)->Arg(10)->Arg(12)->Arg(16);
BENCHMARK(unpack)->Arg(8)->Arg(10)->Arg(12)->Arg(16);
BENCHMARK(crc);
BENCHMARK(write_vga)->Unit(benchmark::kMillisecond);
BENCHMARK(read_vga)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stipple
