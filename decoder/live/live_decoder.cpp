#include "decoder/live/live_decoder.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/index.h"
#include "decoder/live/window_decoder.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"

namespace stipple {
namespace {

std::vector<LiveWindow> windows_of(int slots) {
    std::vector<LiveWindow> windows;
    for (int first = 0; first < slots; first += kLiveCoreSlots)
        windows.push_back(live_window(first, slots));
    return windows;
}

/// By site: 1 if it has a sample.
std::vector<std::uint8_t> sampled_sites(const Measurements& m) {
    std::vector<std::uint8_t> sampled(m.shape.sites());
    for (std::size_t voxel = 0, site = 0; voxel < m.voxels(); ++voxel) {
        if ((m.state[voxel] & Measurements::kLast) != 0) sampled[site] = 1;
        if (++site == sampled.size()) site = 0;
    }
    return sampled;
}

/// Fills what no sample of a window tells: exposures are too long for it, samples are lost, or no
/// site of this place has any. `known` is that of average_in_time, window after window.
void fill_unknown(const Measurements& m, const std::vector<LiveWindow>& windows,
                  const std::vector<std::uint8_t>& known, FluxVideo& x) {
    const std::vector<std::uint8_t> sampled = sampled_sites(m);
    const std::size_t sites = sampled.size();
    std::optional<FluxVideo> nearest;
    for (std::size_t i = 0; i < windows.size(); ++i)
        for (std::size_t site = 0; site < sites; ++site) {
            if (sampled[site] <= known[i * sites + site]) continue;
            if (!nearest) nearest = nearest_samples(m);
            for (int slot = windows[i].core_begin; slot < windows[i].core_end; ++slot)
                x.frame(slot)[site] = nearest->frame(slot)[site];
        }
    fill_unsampled(sampled, x);
}

}  // namespace

std::optional<FluxVideo> decode_live(const Measurements& measurements,
                                     const ProgressCallback& progress) {
    assert(measurements.others.empty());
    const std::size_t sites = measurements.shape.sites();
    FluxVideo result(measurements.slots, measurements.shape);
    const std::vector<LiveWindow> windows = windows_of(measurements.slots);
    std::vector<std::uint8_t> known(windows.size() * sites);
    WindowDecoder decoder;
    for (std::size_t i = 0; i < windows.size(); ++i) {
        const LiveWindow& window = windows[i];
        decoder.decode(measurements, window, {{.begin = window.core_begin, .end = window.core_end}},
                       std::span(known).subspan(i * sites, sites),
                       result.data().subspan(index(window.core_begin) * sites,
                                             index(window.core_end - window.core_begin) * sites));
        if (!progress(static_cast<double>(i + 1) / static_cast<double>(windows.size()))) return {};
    }
    fill_unknown(measurements, windows, known, result);
    return result;
}

}  // namespace stipple
