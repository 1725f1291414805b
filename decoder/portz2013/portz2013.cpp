#include "decoder/portz2013/portz2013.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/naive/nearest_samples.h"
#include "decoder/option_reader.h"
#include "decoder/portz2013/exposure_table.h"

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
    static constexpr Share kSearch1{0, 0.2}, kSolve1{0.2, 0.3}, kFlow{0.3, 0.5},
        kSearch2{0.5, 0.55}, kSolve2{0.55, 1};

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

/// Keys of one stage: `prefix` is "stage1." or "stage2.".
class StageKeys {
  public:
    StageKeys(Config& config, std::string prefix) : config_(config), prefix_(std::move(prefix)) {}
    void number(const char* key, double least, double most, float& value) {
        read_number(config_, prefix_ + key, least, most, value);
    }
    void integer(const char* key, int least, int most, int& value) {
        read_integer(config_, prefix_ + key, least, most, value);
    }
    void search(MatchSearch& search) {
        integer("patch_rows", 1, 64, search.size.rows);
        integer("patch_cols", 1, 64, search.size.cols);
        integer("patch_slots", 1, 32, search.size.slots);
        integer("step_px", 1, 64, search.step_px);
        integer("window_px", 0, 64, search.window_px);
        integer("window_slots", 0, 64, search.window_slots);
        number("sigma", 1e-4, 1e3, search.sigma);
    }
    void admm(MatchAdmmOptions& admm) {
        integer("iterations", 0, 10000, admm.iterations);
        number("rho", 1e-4, 1e6, admm.rho);
        integer("cg_iterations", 1, 10000, admm.cg_iterations);
        number("cg_tolerance", 0, 1, admm.cg_tolerance);
    }

  private:
    Config& config_;
    std::string prefix_;
};

}  // namespace

void read_options(Config& config, Portz2013Options& options) {
    read_number(config, "values_per_flux", 1e-3, 1e6, options.values_per_flux);
    StageKeys first(config, "stage1.");
    first.search(options.stage1.search);
    first.integer("max_matches", 0, 1000, options.stage1.max_matches);
    first.number("gamma", 0, 1e4, options.stage1.gamma);
    first.admm(options.stage1.admm);
    StageKeys second(config, "stage2.");
    second.search(options.stage2.search);
    second.number("search_weight", 0, 1e3, options.stage2.search.weight);
    second.integer("max_matches", 0, 1000, options.stage2.max_matches);
    second.number("gamma", 0, 1e4, options.stage2.gamma);
    second.integer("flow_block_px", 1, 64, options.stage2.flow.block_px);
    second.integer("flow_radius_slots", 0, 64, options.stage2.flow.radius_slots);
    second.number("flow_consistency_px", 0, 1e3, options.stage2.flow.consistency_px);
    second.admm(options.stage2.admm);
    options.stage2.flow.sigma = options.stage2.search.sigma;
}

std::optional<FluxVideo> decode_portz2013(const Measurements& measurements,
                                          const Portz2013Options& options,
                                          const StageObserver& observer,
                                          const ProgressCallback& progress) {
    return Decoder(measurements, options, observer, progress).decode();
}

}  // namespace stipple
