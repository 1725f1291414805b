#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/portz2013/patch_distance.h"
#include "decoder/portz2013/portz2013.h"

namespace stipple {

/// A similar patch and its weight w of Eq. 3.
struct PatchMatch {
    std::int16_t slot = 0;
    std::int16_t row = 0;
    std::int16_t col = 0;
    float weight = 0;
};

/// The matches of a reference patch: the elements of `MatchList::matches` from the end of the
/// previous group to `end`.
struct MatchGroup {
    PatchPosition reference;
    std::size_t end = 0;
};

/// Patches of one size with their matches.
struct MatchList {
    PatchSize size;
    std::vector<MatchGroup> groups;
    std::vector<PatchMatch> matches;

    [[nodiscard]] std::size_t begin_of(std::size_t group) const {
        return group == 0 ? 0 : groups[group - 1].end;
    }
};

/// Largest distance of a match in units of 2 sigma^2: beyond it the weight is below 0.0004.
inline constexpr float kMaxMatchDistance = 8;

/// Distance of the patch at `other` from the patch at `reference`, mean square error in flux^2. If
/// it exceeds `bound`, any value above `bound` may be returned.
using PatchMeasure = std::function<float(const PatchSize& size, const PatchPosition& reference,
                                         const PatchPosition& other, float bound)>;

/// Maximum number of matches of a reference patch.
using MatchCount = std::function<int(const PatchSize& size, const PatchPosition& reference)>;

struct VideoSize {
    int slots = 0;
    FrameShape shape;
};

/// The nearest patches of each reference patch, by exhaustive search of its space-time window; of
/// equally near patches the earlier, higher, further left one. The same for any number of threads.
/// Incomplete if `progress` has stopped it.
[[nodiscard]] MatchList find_matches(const VideoSize& video, const MatchSearch& search,
                                     const PatchMeasure& measure, const MatchCount& max_matches,
                                     const ProgressCallback& progress);

/// Mean square difference of two patches of a video over all planes; a value above `bound` means
/// any value above it.
[[nodiscard]] float patch_difference(const FluxVideo& video, const PatchSize& size,
                                     const PatchPosition& reference, const PatchPosition& other,
                                     float bound) noexcept;

/// w of Eq. 3 for `MatchSearch::weight` 1.
[[nodiscard]] float match_weight(float distance, float sigma) noexcept;

/// Follows each block of a grid along the TV-L1 flow (Zach et al. 2007, OpenCV's implementation)
/// between neighbouring slots, computed in both directions on the square root of luminance. Flows
/// are concatenated. A trajectory ends where the forward-backward check fails or the block would
/// leave the frame. Each position along it, rounded to pixels, is a match; the first match is the
/// block itself. Frames with less than `kMinMotionSide` rows or columns have no flow. The same bits
/// for any number of threads. Incomplete if `progress` has stopped it.
[[nodiscard]] MatchList find_flow_matches(const FluxVideo& video, const FlowMatchOptions& options,
                                          const ProgressCallback& progress);

}  // namespace stipple
