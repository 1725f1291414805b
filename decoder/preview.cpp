#include "decoder/preview.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "decoder/reconstruct.h"

namespace stipple {
namespace {

/// Voxels that are decoded without being asked for: 640 x 480 pixels of 16 slots take `fast` some
/// 2 s and 400 MB on one core, and `naive` a tenth of that.
constexpr double kFastVoxels = 640 * 480 * 16;
constexpr double kNaiveVoxels = 4 * kFastVoxels;

/// Fewer slots give motion too little to go by.
constexpr int kMinSlots = 12;

DecodeOptions options_of(DecodeMethod method) {
    DecodeOptions options{.method = method};
    options.fast.rounds = 1;
    options.fast.last_iterations = 10;
    options.fast.mosaic.last_iterations = 20;
    return options;
}

VideoWindow region_of(const StreamHeader& header, const PreviewOptions& options) {
    const FrameShape whole = decoded_shape(header);
    VideoWindow region{.slots = std::max(kMinSlots, 2 * header.schedule.longest_span_slots()),
                       .shape = whole};
    const double max_voxels = options.method == DecodeMethod::kNaive ? kNaiveVoxels : kFastVoxels;
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

PreviewDecoder::PreviewDecoder(StreamHeader header, const PreviewOptions& options)
    : header_(std::move(header)), method_(options.method), region_(region_of(header_, options)) {}

std::optional<PreviewFrame> PreviewDecoder::decode(std::int64_t first_slot,
                                                   std::span<const SamplePacket> packets,
                                                   const ProgressCallback& progress,
                                                   std::optional<int> shown) const {
    const int slot = shown.value_or(shown_slot());
    VideoWindow window = region_;
    window.first_slot = first_slot;
    Measurements measurements = collect_measurements(header_, packets, window);
    PreviewFrame frame{.slot = first_slot + slot,
                       .shape = region_.shape,
                       .light = {},
                       .saturated = saturated_pixels(measurements)};
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
