#include "decoder/portz2013/portz2013.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/portz2013/exposure_table.h"
#include "decoder/portz2013/match_operator.h"
#include "decoder/portz2013/patch_matches.h"

namespace stipple {
namespace {

std::size_t count(int n) {
    return static_cast<std::size_t>(n);
}

/// Order (slot, site) to (site, slot).
std::vector<float> by_site(const FluxVideo& video) {
    std::vector<float> x(video.voxels());
    const std::size_t sites = video.shape().sites();
    const std::size_t slots = count(video.slots());
    parallel_for(0, video.shape().planes * video.shape().rows, [&](int line) {
        const std::size_t begin = count(line) * count(video.shape().cols);
        for (std::size_t site = begin; site < begin + count(video.shape().cols); ++site)
            for (std::size_t slot = 0; slot < slots; ++slot)
                x[site * slots + slot] = video.data()[slot * sites + site];
    });
    return x;
}

void to_video(std::span<const float> x, FluxVideo& video) {
    const std::size_t sites = video.shape().sites();
    const std::size_t slots = count(video.slots());
    parallel_for(0, video.slots(), [&](int slot) {
        for (std::size_t site = 0; site < sites; ++site)
            video.frame(slot)[site] = x[site * slots + count(slot)];
    });
}

/// The two stages on one block.
class Decoder {
  public:
    Decoder(const Measurements& measurements, const Portz2013Options& options,
            const StageObserver& observer, const ProgressCallback& progress)
        : options_(options),
          observer_(observer),
          progress_(progress),
          table_(measurements),
          x_(nearest_samples(measurements)) {}

    std::optional<FluxVideo> decode() {
        tell("start");
        stage1();
        if (!stopped_) stage2();
        if (stopped_) return {};
        return std::move(x_);
    }

  private:
    /// What part of the whole a step is, by time.
    struct Share {
        double begin;
        double end;
    };
    static constexpr Share kSearch1{0, 0.22}, kSolve1{0.22, 0.45}, kFlow{0.45, 0.55},
        kSearch2{0.55, 0.57}, kSolve2{0.57, 1};

    bool reach(const Share& share, double fraction) {
        stopped_ = stopped_ || !progress_(share.begin + fraction * (share.end - share.begin));
        return !stopped_;
    }
    void tell(std::string_view stage) const {
        if (observer_.finished) observer_.finished(stage, x_);
    }

    void stage1() {
        const auto& stage = options_.stage1;
        const std::array lists{find_matches(
            {table_.slots(), table_.shape()}, stage.search,
            [&](const PatchSize& size, const PatchPosition& a, const PatchPosition& b,
                float bound) { return patch_distance(table_, size, a, b, bound); },
            [&](const PatchSize&, const PatchPosition&) { return stage.max_matches; },
            [&](double fraction) { return reach(kSearch1, fraction); })};
        solve("stage1", lists, stage.gamma, stage.admm, kSolve1);
    }

    void stage2() {
        const auto& stage = options_.stage2;
        MatchList flow = find_flow_matches(x_, stage.flow,
                                           [&](double fraction) { return reach(kFlow, fraction); });
        if (stopped_) return;
        const auto room = [&](const PatchSize& size, const PatchPosition& at) {
            return stage.max_matches - flow_matches_at(flow, size, at);
        };
        MatchList search = find_matches(
            {table_.slots(), table_.shape()}, stage.search,
            [&](const PatchSize& size, const PatchPosition& a, const PatchPosition& b,
                float bound) { return patch_difference(x_, size, a, b, bound); },
            room, [&](double fraction) { return reach(kSearch2, fraction); });
        const std::array lists{std::move(flow), std::move(search)};
        solve("stage2", lists, stage.gamma, stage.admm, kSolve2);
    }

    /// Matches, without itself, of the block of `flow` that the middle of a patch lies in.
    [[nodiscard]] int flow_matches_at(const MatchList& flow, const PatchSize& size,
                                      const PatchPosition& at) const {
        const FrameShape shape = table_.shape();
        const int across = (shape.cols + flow.size.cols - 1) / flow.size.cols;
        const int down = (shape.rows + flow.size.rows - 1) / flow.size.rows;
        const int slot = at.slot + size.slots / 2;
        const int row = (at.row + size.rows / 2) / flow.size.rows;
        const int col = (at.col + size.cols / 2) / flow.size.cols;
        const std::size_t group = count((slot * down + row) * across + col);
        return static_cast<int>(flow.groups[group].end - flow.begin_of(group)) - 1;
    }

    void solve(std::string_view name, std::span<const MatchList> lists, float gamma,
               MatchAdmmOptions admm, const Share& share) {
        if (stopped_) return;
        MatchOperator problem(table_, lists, gamma);
        // rho is in the paper's unit of light, x in ours.
        admm.rho *= options_.values_per_flux;
        std::vector<float> x = by_site(x_);
        int done = 0;
        minimise_by_admm(
            problem, admm,
            [&](int iteration, double objective) {
                done = iteration + 1;
                if (observer_.iterated) observer_.iterated(name, iteration, objective);
                return true;
            },
            [&] { return reach(share, static_cast<double>(done) / admm.iterations); }, x);
        to_video(x, x_);
        tell(name);
    }

    const Portz2013Options& options_;
    const StageObserver& observer_;
    const ProgressCallback& progress_;
    ExposureTable table_;
    FluxVideo x_;
    bool stopped_ = false;
};

constexpr KeyRange kMatches{0, 1000};
constexpr KeyRange kGamma{0, 1e4};

void read_search(const KeyReader& read, MatchSearch& search) {
    constexpr KeyRange kSide{1, 64};
    constexpr KeyRange kWindow{0, 64};
    read({"patch_rows", kSide, "pixels", "rows of a patch"}, search.size.rows);
    read({"patch_cols", kSide, "pixels", "columns of a patch"}, search.size.cols);
    read({"patch_slots", {1, 32}, "slots", "slots of a patch"}, search.size.slots);
    read({"step_px", kSide, "pixels", "stride of reference patches"}, search.step_px);
    read({"window_px", kWindow, "pixels", "search radius in rows and columns"}, search.window_px);
    read({"window_slots", kWindow, "slots", "search radius in slots"}, search.window_slots);
    read({"sigma", {1e-4, 1e3}, "flux", "sigma of Eq. 3"}, search.sigma);
}

void read_admm(const KeyReader& read, MatchAdmmOptions& admm) {
    read({"iterations", {0, 10000}, "", "iterations of ADMM"}, admm.iterations);
    read({"rho", {1e-4, 1e6}, "", "penalty of ADMM: the larger, the smaller the steps"}, admm.rho);
    read({"cg_iterations", {1, 10000}, "", "max steps of conjugate gradients in each"},
         admm.cg_iterations);
    read({"cg_tolerance", {0, 1}, "", "tolerance of the residual, relative to the right side"},
         admm.cg_tolerance);
}

}  // namespace

void read_options(Config& config, Portz2013Options& options) {
    const KeyReader read(config);
    read({"values_per_flux", {1e-3, 1e6}, "1/flux", "of Eq. 1 for light 1.0: unit of rho"},
         options.values_per_flux);
    const KeyReader first(config, "stage1.");
    read_search(first, options.stage1.search);
    first({"max_matches", kMatches, "", "max matches of a reference patch"},
          options.stage1.max_matches);
    first({"gamma", kGamma, "", "weight of differences between matches"}, options.stage1.gamma);
    read_admm(first, options.stage1.admm);
    const KeyReader second(config, "stage2.");
    read_search(second, options.stage2.search);
    second({"search_weight", {0, 1e3}, "", "factor of the weights of matches by search"},
           options.stage2.search.weight);
    second({"max_matches", kMatches, "", "max matches of a patch, of both kinds"},
           options.stage2.max_matches);
    second({"gamma", kGamma, "", "weight of differences between matches"}, options.stage2.gamma);
    FlowMatchOptions& flow = options.stage2.flow;
    second({"flow_block_px", {1, 64}, "pixels", "side of the blocks that follow the flow"},
           flow.block_px);
    second({"flow_radius_slots", {0, 64}, "slots", "reach of a trajectory, either way"},
           flow.radius_slots);
    second({"flow_consistency_px", {0, 1e3}, "pixels", "largest error of the flow back"},
           flow.consistency_px);
    read_admm(second, options.stage2.admm);
    flow.sigma = options.stage2.search.sigma;
}

std::optional<FluxVideo> decode_portz2013(const Measurements& measurements,
                                          const Portz2013Options& options,
                                          const StageObserver& observer,
                                          const ProgressCallback& progress) {
    return Decoder(measurements, options, observer, progress).decode();
}

}  // namespace stipple
