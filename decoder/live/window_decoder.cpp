#include "decoder/live/window_decoder.h"

#include <algorithm>
#include <cstddef>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/live/residual_blur.h"
#include "decoder/measurements.h"

namespace stipple {
namespace {

constexpr int kBefore = 8;
constexpr int kAfter = LiveWindow::kMaxSlots - kLiveCoreSlots - kBefore;

/// Calls body(run) for all sites.
template <typename Body>
void for_each_run(const Measurements& m, const LiveWindow& window, const Body& body) {
    const std::vector<SiteRun> runs = site_runs(m.shape);
    parallel_for(0, static_cast<int>(runs.size()), [&](int i) {
        body(WindowRun{m, window, runs[index(i)]});
    });
}

}  // namespace

LiveWindow live_window(int slot, int slots) {
    const int first = slot / kLiveCoreSlots * kLiveCoreSlots;
    return {.begin = std::clamp(slots - LiveWindow::kMaxSlots, 0, std::max(first - kBefore, 0)),
            .core_begin = first,
            .core_end = std::min(first + kLiveCoreSlots, slots),
            .end = std::min(first + kLiveCoreSlots + kAfter, slots)};
}

void WindowDecoder::decode(const Measurements& m, const LiveWindow& window, const Wanted& wanted,
                           std::span<std::uint8_t> known, std::span<float> result) {
    const int span = wanted.longest_span_slots;
    // The exposures that are open in the slots of a step reach this far.
    const auto reached = [&](const WindowSlots& slots, int begin, int end) {
        return WindowSlots{.begin = std::max(slots.begin - span + 1, begin),
                           .end = std::min(slots.end + span - 1, end)};
    };
    const WindowSlots fine = reached(wanted.slots, window.core_begin, window.core_end);
    const WindowSlots coarse = reached(fine, window.begin, window.end);
    const std::size_t voxels = index(window.slots()) * m.shape.sites();
    for (std::vector<float>* array : {&light_, &precision_, &weighted_}) array->resize(voxels);
    const FrameShape plane{.rows = m.shape.rows, .cols = m.shape.cols, .planes = 1};
    const auto add_residuals = [&](const WindowSlots& slots, const auto& add) {
        parallel_for(
            (slots.begin - window.begin) * m.shape.planes,
            (slots.end - window.begin) * m.shape.planes, [&](int i) {
                const auto part = [&](std::vector<float>& all) {
                    return std::span(all).subspan(index(i) * plane.pixels(), plane.pixels());
                };
                add(plane, PlaneResiduals{part(precision_), part(weighted_)}, part(light_));
            });
    };
    for_each_run(m, window, [&](const WindowRun& run) {
        average_in_time(run, light_, known);
        spread_residuals(run, coarse, light_, {precision_, weighted_});
    });
    add_residuals(coarse, add_coarse_residuals);
    for_each_run(m, window, [&](const WindowRun& run) {
        spread_residuals(run, fine, light_, {precision_, weighted_});
    });
    add_residuals(fine, add_fine_residuals);
    const WindowSlots last = reached(wanted.slots, window.begin, window.end);
    const LiveWindow shown{last.begin, wanted.slots.begin, wanted.slots.end, last.end};
    const auto light =
        std::span(light_).subspan(index(last.begin - window.begin) * m.shape.sites());
    for_each_run(m, shown, [&](const WindowRun& run) { restore_sums(run, light, result); });
}

}  // namespace stipple
