#include "decoder/conventional/shahar2011.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/index.h"
#include "decoder/conventional/frame_decoding.h"
#include "decoder/decode_method.h"
#include "decoder/frame_exposures.h"
#include "decoder/measurements.h"
#include "decoder/motion/frame_interpolation.h"

namespace stipple {
namespace {

/// Frames at even distances in time.
struct EvenFrames {
    FluxVideo light;
    float first_centre = 0;  ///< slots, as the next two
    float distance = 0;
    float exposure = 0;  ///< 0 with gaps inside
};

/// The least distance of two frames, if that of all is a multiple of it; otherwise 0.
int period_of(std::span<const FrameExposure> exposures) {
    int least = std::numeric_limits<int>::max();
    int divisor = 0;
    for (std::size_t i = 1; i < exposures.size(); ++i) {
        const int distance = exposures[i].last_slot - exposures[i - 1].last_slot;
        least = std::min(least, distance);
        divisor = std::gcd(divisor, distance);
    }
    return divisor == least ? divisor : 0;
}

/// Lost frames are interpolated.
EvenFrames even_frames(const FluxVideo& frames, std::span<const FrameExposure> exposures,
                       int period) {
    const FrameExposure& first = exposures.front();
    const bool gaps_inside = first.last_slot - first.first_slot + 1 != first.open_slots;
    EvenFrames even{{},
                    first.centre_slot,
                    static_cast<float>(period),
                    gaps_inside ? 0.0F : static_cast<float>(first.open_slots)};
    std::vector<float> numbers;
    numbers.reserve(exposures.size());
    for (const FrameExposure& e : exposures) {
        const int number = (e.last_slot - first.last_slot) / period;
        numbers.push_back(static_cast<float>(number));
    }
    const int count = static_cast<int>(numbers.back()) + 1;
    even.light = count == frames.slots() ? frames : interpolate_frames(frames, numbers, count);
    return even;
}

EvenFrames doubled(const EvenFrames& frames, float per_light, const OctaveOptions& options) {
    const bool gapless = frames.exposure >= frames.distance;
    const Octave octave = gapless ? Octave::kSplit : Octave::kInsert;
    return {upsampled_frames(frames.light, octave, per_light, options),
            gapless ? frames.first_centre - frames.distance / 4 : frames.first_centre,
            frames.distance / 2, gapless ? frames.exposure / 2 : frames.exposure};
}

/// Frames that lie at slots are copied, the first and last one also beyond them.
FluxVideo at_slots(const EvenFrames& frames, int slots) {
    if (frames.distance != 1 || frames.first_centre != std::floor(frames.first_centre)) {
        std::vector<float> centres;
        centres.reserve(index(frames.light.slots()));
        for (int k = 0; k < frames.light.slots(); ++k)
            centres.push_back(frames.first_centre + frames.distance * static_cast<float>(k));
        return interpolate_frames(frames.light, centres, slots);
    }
    FluxVideo x(slots, frames.light.shape());
    const int first = static_cast<int>(frames.first_centre);
    for (int slot = 0; slot < slots; ++slot)
        std::ranges::copy(frames.light.frame(std::clamp(slot - first, 0, frames.light.slots() - 1)),
                          x.frame(slot).begin());
    return x;
}

}  // namespace

std::optional<FluxVideo> super_resolve_time(const BlockTask& block,
                                            const Shahar2011Options& options) {
    const Measurements& measurements = block.measurements;
    const auto exposures = exposures_of_frames(measurements);
    if (exposures.empty()) return FluxVideo(measurements.slots, measurements.shape);
    const DeliveredFrames delivered = delivered_frames(block, exposures);
    const int period = period_of(exposures);
    if (period < 2 || options.octaves == 0)
        return video_of_frames(measurements, exposures, delivered.light);
    EvenFrames frames = even_frames(delivered.light, exposures, period);
    float per_light = delivered.noise.per_light;
    for (int octave = 0; octave < options.octaves && frames.distance >= 2; ++octave) {
        frames = doubled(frames, per_light, options.octave);
        if (!block.progress((octave + 1.0) / (options.octaves + 1.0))) return {};
    }
    FluxVideo x = at_slots(frames, measurements.slots);
    back_project_residual(measurements, exposures, delivered.light, x);
    return x;
}

void read_options(Config& config, Shahar2011Options& options) {
    OctaveOptions& octave = options.octave;
    const KeyReader read(config);
    read({"octaves", {0, 6}, "", "most times that the number of frames is doubled"},
         options.octaves);
    read({"patch_px", {1, 16}, "pixels", "side of a space-time patch"}, octave.patch_px);
    read({"step_px", {1, 16}, "pixels", "stride of patches; patch_px at most counts"},
         octave.step_px);
    read({"search_px", {0, 64}, "pixels", "search radius of examples"}, octave.search_px);
    read({"search_frames", {0, 64}, "frames", "frames that are searched, either way"},
         octave.search_frames);
    read({"examples", {1, 100}, "", "most examples of a patch"}, octave.examples);
    read({"match_sigma", {1e-4, 10}, "", "sigma of matches on the scale 2 sqrt(light)"},
         octave.match_sigma);
    read({"start_weight", {1e-4, 100}, "", "weight of the interpolated frames, in examples"},
         octave.start_weight);
}

}  // namespace stipple
