#include "decoder/live/live_slot_decoder.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>

#include "core/exposure_schedule.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/block_partition.h"
#include "decoder/naive/nearest_samples.h"

namespace stipple {
namespace {

/// Even, so that the bands have the pairs of rows of their tile. More rows are further from the
/// processor's cache, and of fewer rows more are decoded twice.
constexpr std::int64_t kBandRows = 48;

/// Bands of the tiles in which `decode` decodes such frames.
std::vector<Tile> bands_of(FrameShape shape) {
    std::vector<Tile> bands;
    for (const auto& [rows, cols] : frame_tiles(shape))
        for (std::int64_t row = rows.begin; row < rows.core_end; row += kBandRows) {
            const HaloRange band{
                .begin = std::max<std::int64_t>(row - WindowDecoder::kReachRows, rows.begin),
                .core_begin = std::max(row, rows.core_begin),
                .core_end = std::min(row + kBandRows, rows.core_end),
                .end = std::min(row + kBandRows + WindowDecoder::kReachRows, rows.end)};
            if (band.core_begin < band.core_end) bands.push_back({band, cols});
        }
    return bands;
}

VideoWindow part_of(const VideoWindow& window, const Tile& band) {
    const auto& [rows, cols] = band;
    return {.first_slot = window.first_slot,
            .slots = window.slots,
            .first_row = window.first_row + static_cast<int>(rows.begin),
            .first_col = window.first_col + static_cast<int>(cols.begin),
            .shape = {.rows = static_cast<int>(rows.end - rows.begin),
                      .cols = static_cast<int>(cols.end - cols.begin),
                      .planes = window.shape.planes}};
}

/// Copies the core of a band; both of order (plane, row, col).
template <typename T>
void copy_core(const std::vector<T>& from, const Tile& band, FrameShape shape, std::span<T> to) {
    const auto& [rows, cols] = band;
    const std::int64_t band_rows = rows.end - rows.begin, band_cols = cols.end - cols.begin;
    for (std::int64_t plane = 0; plane < shape.planes; ++plane)
        for (std::int64_t row = rows.core_begin; row < rows.core_end; ++row)
            std::copy_n(from.begin() + (plane * band_rows + row - rows.begin) * band_cols +
                            cols.core_begin - cols.begin,
                        cols.core_end - cols.core_begin,
                        to.begin() + (plane * shape.rows + row) * shape.cols + cols.core_begin);
}

}  // namespace

int slots_with_a_sample(const ExposureSchedule& schedule) {
    int most = 0;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            const auto exposures = schedule.exposures(row, col);
            if (exposures.empty()) continue;
            // From just after the begin of one exposure to the end of the next one.
            int begin = static_cast<int>(exposures.back().first_slot) - schedule.period_slots();
            for (const Exposure& next : exposures) {
                const auto first = static_cast<int>(next.first_slot);
                most = std::max(most, first + next.span_slots() - (begin + 1));
                begin = first;
            }
        }
    return most;
}

LiveSlotDecoder::Frame LiveSlotDecoder::decode(const StreamHeader& header,
                                               std::span<const SamplePacket> packets,
                                               const VideoWindow& window, const LiveWindow& live,
                                               int slot) {
    assert(live.begin == 0 && live.end == window.slots && live.slots() <= LiveWindow::kMaxSlots);
    const FrameShape shape = window.shape;
    const WindowDecoder::Wanted wanted{
        WindowSlots{slot, slot + 1},
        header.switches.empty() ? header.schedule.longest_span_slots() : LiveWindow::kMaxSlots};
    Frame frame;
    frame.light = FluxVideo(1, shape);
    frame.known.resize(shape.sites());
    const std::vector<Tile> bands = bands_of(shape);
    const auto decode_band = [&](const Tile& band, Memory& memory) {
        const VideoWindow part = part_of(window, band);
        collect_measurements(header, packets, part, memory.measurements);
        memory.light.resize(part.shape.sites());
        memory.known.resize(part.shape.sites());
        memory.decoder.decode(memory.measurements, live, wanted, memory.known, memory.light);
        copy_core<float>(memory.light, band, shape, frame.light.data());
        copy_core<std::uint8_t>(memory.known, band, shape, frame.known);
    };
    const int threads = std::min(thread_count(), static_cast<int>(bands.size()));
    memory_.resize(index(threads));
    std::atomic<std::size_t> next = 0;
    parallel_for(0, threads, [&](int i) {
        run_on_this_thread([&] {
            for (std::size_t band = next++; band < bands.size(); band = next++)
                decode_band(bands[band], memory_[index(i)]);
        });
    });
    fill_unsampled(frame.known, frame.light);
    for (float& light : frame.light.data()) light = std::max(light, 0.0F);
    return frame;
}

}  // namespace stipple
