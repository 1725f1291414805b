#include "decoder/live/live_decoder.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/live/exposure_kernels.h"
#include "decoder/live/residual_blur.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"

namespace stipple {
namespace {

constexpr int kCore = 8;
constexpr int kBefore = 8;
constexpr int kAfter = LiveWindow::kMaxSlots - kCore - kBefore;

std::vector<LiveWindow> windows_of(int slots) {
    std::vector<LiveWindow> windows;
    for (int first = 0; first < slots; first += kCore) {
        const int core_end = std::min(first + kCore, slots);
        windows.push_back({.begin = std::max(first - kBefore, 0),
                           .core_begin = first,
                           .core_end = core_end,
                           .end = std::min(first + kCore + kAfter, slots)});
    }
    return windows;
}

/// Decodes one window after the other, in the same memory.
class WindowDecoder {
  public:
    WindowDecoder(const Measurements& measurements, FluxVideo& result)
        : m_(measurements),
          runs_(site_runs(measurements.shape)),
          result_(result),
          light_(index(std::min(measurements.slots, LiveWindow::kMaxSlots)) *
                 measurements.shape.sites()),
          precision_(light_.size()),
          weighted_(light_.size()) {}

    /// `known` as of average_in_time.
    void decode(const LiveWindow& window, std::span<std::uint8_t> known) {
        const WindowSlots core{.begin = window.core_begin, .end = window.core_end};
        const WindowSlots all{.begin = window.begin, .end = window.end};
        for_each_run(window, [&](const WindowRun& run) {
            average_in_time(run, light_, known);
            spread_residuals(run, all, light_, {precision_, weighted_});
        });
        add_residuals(window, all, add_coarse_residuals);
        for_each_run(window, [&](const WindowRun& run) {
            spread_residuals(run, core, light_, {precision_, weighted_});
        });
        add_residuals(window, core, add_fine_residuals);
        for_each_run(window,
                     [&](const WindowRun& run) { restore_sums(run, light_, result_.data()); });
    }

  private:
    template <typename Body>
    void for_each_run(const LiveWindow& window, const Body& body) const {
        parallel_for(0, static_cast<int>(runs_.size()), [&](int i) {
            body(WindowRun{m_, window, runs_[index(i)]});
        });
    }

    /// Calls add(shape, residuals, light) for all planes of these slots.
    template <typename Add>
    void add_residuals(const LiveWindow& window, const WindowSlots& slots, const Add& add) {
        const FrameShape plane{.rows = m_.shape.rows, .cols = m_.shape.cols, .planes = 1};
        const auto planes = m_.shape.planes;
        parallel_for(
            (slots.begin - window.begin) * planes, (slots.end - window.begin) * planes, [&](int i) {
                const std::size_t first = index(i) * plane.pixels();
                const auto part = [&](std::vector<float>& all) {
                    return std::span(all).subspan(first, plane.pixels());
                };
                add(plane, PlaneResiduals{part(precision_), part(weighted_)}, part(light_));
            });
    }

    const Measurements& m_;
    std::vector<SiteRun> runs_;
    FluxVideo& result_;
    // Order (slot of the window, plane, row, col).
    std::vector<float> light_;
    std::vector<float> precision_;
    std::vector<float> weighted_;
};

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
    WindowDecoder decoder(measurements, result);
    for (std::size_t i = 0; i < windows.size(); ++i) {
        decoder.decode(windows[i], std::span(known).subspan(i * sites, sites));
        if (!progress(static_cast<double>(i + 1) / static_cast<double>(windows.size()))) return {};
    }
    fill_unknown(measurements, windows, known, result);
    return result;
}

}  // namespace stipple
