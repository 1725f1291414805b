#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/flux_video.h"
#include "decoder/portz2013/patch_distance.h"
#include "decoder/progress_callback.h"

namespace stipple {

/// A patch that looks like another one, and w of Eq. 3: how much.
struct PatchMatch {
    std::int16_t slot = 0;
    std::int16_t row = 0;
    std::int16_t col = 0;
    float weight = 0;
};

/// The matches of a reference patch: those of `MatchList::matches` up to `end`, from where the
/// group before ends.
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

/// Where reference patches lie and where matches are looked for.
struct MatchSearch {
    PatchSize size;        ///< cut to the block where that is smaller
    int step_px = 3;       ///< of reference patches, in rows and columns; none overlap in time
    int window_px = 8;     ///< up to so many rows and columns away
    int window_slots = 2;  ///< and so many slots
    float sigma = 0.05F;   ///< of Eq. 3, flux: w = weight exp(-d / (2 sigma^2))
    float weight = 1;
    bool with_itself = true;  ///< each patch is a match of its own, beside the `most`
};

/// Distances above so many 2 sigma^2 are no matches: their weight would be below 0.0004.
inline constexpr float kFaintestMatch = 8;

/// Distance of the patch at `other` from that at `reference`, mean square error in flux^2; anything
/// larger than `bound` will do if it exceeds that.
using PatchMeasure = std::function<float(const PatchSize& size, const PatchPosition& reference,
                                         const PatchPosition& other, float bound)>;

/// How many matches a reference patch may have.
using MatchCount = std::function<int(const PatchSize& size, const PatchPosition& reference)>;

struct VideoSize {
    int slots = 0;
    FrameShape shape;
};

/// The nearest patches of each reference patch, by exhaustive search of its space-time window; of
/// equally near ones the earlier, higher, further left. The same for any number of threads. Not
/// complete if `progress` has stopped it.
[[nodiscard]] MatchList find_matches(const VideoSize& video, const MatchSearch& search,
                                     const PatchMeasure& measure, const MatchCount& most,
                                     const ProgressCallback& progress);

/// Mean square difference of two patches of a video, all planes together; more than `bound` stands
/// for anything above it.
[[nodiscard]] float patch_difference(const FluxVideo& video, const PatchSize& size,
                                     const PatchPosition& reference, const PatchPosition& other,
                                     float bound) noexcept;

/// w of Eq. 3 without its factor.
[[nodiscard]] float match_weight(float distance, float sigma) noexcept;

}  // namespace stipple
