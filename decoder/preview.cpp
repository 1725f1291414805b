#include "decoder/preview.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "decoder/decode_cost.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"

namespace stipple {
namespace {

/// Voxels that are decoded without being asked for: 640 x 480 pixels of 16 slots take `fast` some
/// 2 s and 400 MB on one core, and `naive` a tenth of that.
constexpr double kFastVoxels = 640 * 480 * 16;
constexpr double kNaiveVoxels = 4 * kFastVoxels;
constexpr double kLiveVoxels = 16 * kFastVoxels;

/// Fewer slots give motion too little to go by.
constexpr int kMinSlots = 12;

DecodeOptions options_of(DecodeMethod method) {
    DecodeOptions options{.method = method};
    options.fast.rounds = 1;
    options.fast.last_iterations = 10;
    options.fast.mosaic.last_iterations = 20;
    return options;
}

/// The largest of a figure of the schedules of a stream.
int most_of(const StreamHeader& header, const std::function<int(const ExposureSchedule&)>& figure) {
    int most = figure(header.schedule);
    for (const ScheduleSwitch& part : header.switches) most = std::max(most, figure(part.schedule));
    return most;
}

/// True if each pixel has a sample in any window of `live`, the shortest of which is the first one.
bool in_live_window(const StreamHeader& header, DecodeMethod method) {
    return method == DecodeMethod::kLive &&
           most_of(header, slots_with_a_sample) <= live_window(0, LiveWindow::kMaxSlots).slots();
}

double max_voxels_of(const StreamHeader& header, DecodeMethod method) {
    if (in_live_window(header, method)) return kLiveVoxels;
    return method == DecodeMethod::kFast ? kFastVoxels : kNaiveVoxels;
}

VideoWindow region_of(const StreamHeader& header, const PreviewOptions& options) {
    const FrameShape whole = decoded_shape(header);
    const int longest = most_of(header, std::mem_fn(&ExposureSchedule::longest_span_slots));
    VideoWindow region{.slots = std::max(kMinSlots, 2 * longest), .shape = whole};
    if (in_live_window(header, options.method)) region.slots = LiveWindow::kMaxSlots;
    const double max_voxels = max_voxels_of(header, options.method);
    const double scale =
        std::min(1.0, std::sqrt(max_voxels / static_cast<double>(region.voxels())));
    const auto side = [&](int all, int wanted) {
        return wanted > 0 ? std::min(wanted, all)
                          : std::max(1, static_cast<int>(std::floor(all * scale)));
    };
    const FrameShape wanted = options.size.value_or(FrameShape{.rows = 0, .cols = 0});
    region.shape.rows = side(whole.rows, wanted.rows);
    region.shape.cols = side(whole.cols, wanted.cols);
    region.first_row = (whole.rows - region.shape.rows) / 2;
    region.first_col = (whole.cols - region.shape.cols) / 2;
    return region;
}

/// By pixel: it has samples of some plane, and all of these are saturated.
std::vector<bool> saturated_pixels(const Measurements& measurements) {
    const std::size_t sites = measurements.shape.sites();
    const std::size_t pixels = measurements.shape.pixels();
    std::vector<bool> sampled(sites), told(sites);
    for (std::size_t voxel = 0; voxel < measurements.voxels(); ++voxel) {
        const std::uint8_t state = measurements.state[voxel];
        if ((state & Measurements::kLast) == 0) continue;
        sampled[voxel % sites] = true;
        if ((state & Measurements::kSaturated) == 0) told[voxel % sites] = true;
    }
    std::vector<bool> result(pixels);
    for (std::size_t site = 0; site < sites; ++site)
        if (sampled[site] && !told[site]) result[site % pixels] = true;
    return result;
}

}  // namespace

double PreviewFrame::saturated_fraction() const {
    const auto count = std::count(saturated.begin(), saturated.end(), true);
    return static_cast<double>(count) / static_cast<double>(saturated.size());
}

double PreviewFrame::mean_light() const {
    return std::accumulate(light.begin(), light.end(), 0.0) / static_cast<double>(light.size());
}

PreviewDecoder::PreviewDecoder(const StreamHeader& header, const PreviewOptions& options)
    : header_(header),
      in_live_window_(in_live_window(header_, options.method)),
      method_(options.method == DecodeMethod::kLive && !in_live_window_ ? DecodeMethod::kNaive
                                                                        : options.method),
      region_(region_of(header_, options)) {}

PreviewSlots PreviewDecoder::newest(std::int64_t end) const {
    const std::int64_t begin = std::max<std::int64_t>(end - slots(), 0);
    if (!in_live_window_) return around(begin + slots() / 2, end);
    const std::int64_t core_end = std::max(end - kLiveCoreSlots, begin + 1);
    return {{begin, std::max(core_end - kLiveCoreSlots, begin), core_end, end}, core_end - 1};
}

PreviewSlots PreviewDecoder::around(std::int64_t slot, std::int64_t slots) const {
    slots = std::max(slots, slot + 1);
    if (in_live_window_) {
        const std::int64_t core_begin = block_begin(block_of(slot, slots));
        const HaloRange block = slot_range(core_begin, slots, halo_at(header_, core_begin));
        const LiveWindow window = live_window(static_cast<int>(slot - block.begin),
                                              static_cast<int>(block.end - block.begin));
        return {{block.begin + window.begin, block.begin + window.core_begin,
                 block.begin + window.core_end, block.begin + window.end},
                slot};
    }
    const std::int64_t last_begin = std::max<std::int64_t>(slots - region_.slots, 0);
    const std::int64_t begin = std::clamp<std::int64_t>(slot - region_.slots / 2, 0, last_begin);
    return {{begin, slot, slot + 1, begin + region_.slots}, slot};
}

std::optional<PreviewFrame> PreviewDecoder::decode(const PreviewSlots& slots,
                                                   std::span<const SamplePacket> packets,
                                                   const ProgressCallback& progress) {
    const auto& [range, shown] = slots;
    const auto slot = static_cast<int>(shown - range.begin);
    VideoWindow window = region_;
    window.first_slot = range.begin;
    window.slots = static_cast<int>(range.end - range.begin);
    PreviewFrame frame{.slot = shown, .shape = region_.shape, .light = {}, .saturated = {}};
    if (in_live_window_) {
        if (!progress(0)) return std::nullopt;
        const LiveWindow live{0, static_cast<int>(range.core_begin - range.begin),
                              static_cast<int>(range.core_end - range.begin), window.slots};
        const auto decoded = live_.decode(header_, packets, window, live, slot);
        frame.light.assign(decoded.light.data().begin(), decoded.light.data().end());
        frame.saturated.resize(region_.shape.pixels());
        for (std::size_t site = 0; site < decoded.known.size(); ++site)
            if (decoded.known[site] == 1) frame.saturated[site % frame.saturated.size()] = true;
        return frame;
    }
    Measurements measurements = collect_measurements(header_, packets, window);
    frame.saturated = saturated_pixels(measurements);
    const auto video =
        decode_block(std::move(measurements), header_.calibration, options_of(method_), progress);
    if (!video) return std::nullopt;
    const auto light = video->frame(slot);
    frame.light.resize(light.size());
    std::transform(light.begin(), light.end(), frame.light.begin(),
                   [](float value) { return std::max(value, 0.0F); });
    return frame;
}

}  // namespace stipple
