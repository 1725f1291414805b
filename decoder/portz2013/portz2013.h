#pragma once

#include <cstdint>
#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/portz2013/patch_distance.h"
#include "decoder/stage_observer.h"

namespace stipple {

class Config;
struct Measurements;

/// Positions of reference patches and search range of their matches.
struct MatchSearch {
    PatchSize size;        ///< cut to the block where that is smaller
    int step_px = 3;       ///< stride of reference patches, rows and columns; no overlap in time
    int window_px = 8;     ///< maximum distance in rows and in columns
    int window_slots = 2;  ///< maximum distance in slots
    float sigma = 0.05F;   ///< of Eq. 3, flux: w = weight exp(-d / (2 sigma^2))
    float weight = 1;
    bool with_itself = true;  ///< each patch matches itself, in addition to `max_matches`
};

/// Matches along motion, of blocks one slot long.
struct FlowMatchOptions {
    int block_px = 4;          ///< side of a block
    int radius_slots = 5;      ///< maximum length of trajectories, forwards and backwards
    float consistency_px = 1;  ///< tolerance of the forward-backward check
    float sigma = 0.05F;       ///< as in MatchSearch
};

/// Minimisation by ADMM (match_operator.h).
struct MatchAdmmOptions {
    int iterations = 10;
    float rho = 2;               ///< larger: smaller steps; per unit of light
    int cg_iterations = 10;      ///< maximum of conjugate gradients, in each iteration
    float cg_tolerance = 1e-3F;  ///< of the residual, relative to the right side; 1.2e-7 at least
};

/// Options of the method `portz2013`. docs/decoder_portz2013.md lists the published values and the
/// deviations from the paper.
struct Portz2013Options {
    struct Stage1 {
        MatchSearch search{.size = {6, 6, 4}, .step_px = 3, .sigma = 0.15F};
        int max_matches = 12;
        float gamma = 0.5F;  ///< not published; nor are sigma, window and conjugate gradients
        MatchAdmmOptions admm{.iterations = 10, .rho = 2};
    };
    struct Stage2 {
        FlowMatchOptions flow{.sigma = 0.1F};  ///< block_px 4 or 2 in the paper, by clip
        MatchSearch search{
            .size = {6, 6, 3}, .step_px = 3, .sigma = 0.1F, .weight = 0.5F, .with_itself = false};
        int max_matches = 20;  ///< of both kinds together
        float gamma = 0.5F;
        MatchAdmmOptions admm{.iterations = 50, .rho = 10};
    };
    Stage1 stage1;
    Stage2 stage2;
    /// Y of Eq. 1 for light 1.0, r / s of the paper's sensor: the published values of rho have this
    /// unit.
    float values_per_flux = 0.5F;
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Portz2013Options& options);

/// Maximum number of sites in the core of a tile: a block of 64 slots then needs about 3 GB.
inline constexpr std::int64_t kPortz2013CoreSites = std::int64_t{1} << 16;

/// Random Coded Sampling for High-Speed HDR Video (Portz, Zhang, Jiang, ICCP 2013), Sec. 4. Stage 1
/// explains each patch by the samples of similar patches. Stage 2 repeats this with patches found
/// along motion in the estimate and by search in it. Observed stages: `start` (nearest samples),
/// `stage1`, `stage2`. Memory: 4 bytes per row of the problem, about 490 bytes per voxel. Returns
/// nothing if `progress` has stopped it. The same bits for any number of threads.
[[nodiscard]] std::optional<FluxVideo> decode_portz2013(
    const Measurements& measurements, const Portz2013Options& options,
    const StageObserver& observer = {},
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
