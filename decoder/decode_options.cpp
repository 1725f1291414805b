#include "decoder/decode_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

void read_number(Config& config, std::string_view key, double least, double most, float& value) {
    value = static_cast<float>(config.number(key, static_cast<double>(value), least, most));
}

void read_integer(Config& config, std::string_view key, int least, int most, int& value) {
    value = static_cast<int>(config.integer(key, value, least, most));
}

void read_options(Config& config, MotionTvOptions& fast) {
    read_integer(config, "at_rest.iterations", 0, 10000, fast.at_rest.iterations);
    read_number(config, "at_rest.spatial_weight", 0, 1e4, fast.at_rest.spatial_weight);
    read_number(config, "at_rest.temporal_weight", 0, 1e4, fast.at_rest.temporal_weight);
    read_integer(config, "along_motion.iterations", 0, 10000, fast.along_motion.iterations);
    read_number(config, "along_motion.spatial_weight", 0, 1e4, fast.along_motion.spatial_weight);
    read_number(config, "along_motion.temporal_weight", 0, 1e4, fast.along_motion.temporal_weight);
    read_integer(config, "rounds", 0, 100, fast.rounds);
    read_integer(config, "last_iterations", 0, 10000, fast.last_iterations);
    read_number(config, "mosaic.spatial_weight", 0, 1e4, fast.mosaic.spatial_weight);
    read_number(config, "mosaic.chroma_weight", 0, 1e4, fast.mosaic.chroma_weight);
    read_integer(config, "mosaic.last_iterations", 0, 10000, fast.mosaic.last_iterations);
    read_number(config, "step", 1e-6, 1, fast.step);
    read_number(config, "step_flux", 1e-4, 1e4, fast.step_flux);
    read_number(config, "max_step_ratio", 1, 1e4, fast.max_step_ratio);
}

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

void read_options(Config& config, Portz2013Options& portz) {
    read_number(config, "values_per_flux", 1e-3, 1e6, portz.values_per_flux);
    StageKeys first(config, "stage1.");
    first.search(portz.stage1.search);
    first.integer("most_matches", 0, 1000, portz.stage1.most_matches);
    first.number("gamma", 0, 1e4, portz.stage1.gamma);
    first.admm(portz.stage1.admm);
    StageKeys second(config, "stage2.");
    second.search(portz.stage2.search);
    second.number("search_weight", 0, 1e3, portz.stage2.search.weight);
    second.integer("most_matches", 0, 1000, portz.stage2.most_matches);
    second.number("gamma", 0, 1e4, portz.stage2.gamma);
    second.integer("flow_block_px", 1, 64, portz.stage2.flow.block_px);
    second.integer("flow_radius_slots", 0, 64, portz.stage2.flow.radius_slots);
    second.number("flow_consistency_px", 0, 1e3, portz.stage2.flow.consistency_px);
    second.admm(portz.stage2.admm);
    portz.stage2.flow.sigma = portz.stage2.search.sigma;
}

void read_options(Config& config, CollaborativeOptions& best) {
    read_integer(config, "iterations", 0, 10000, best.iterations);
    read_integer(config, "motion_every", 1, 10000, best.motion_every);
    read_integer(config, "match_every", 1, 10000, best.match_every);
    read_integer(config, "block_step", 1, kBlockSide, best.block_step);
    read_integer(config, "matching.slots", 0, 32, best.matching.slots);
    read_integer(config, "matching.own_radius", 0, 32, best.matching.own_radius);
    read_integer(config, "matching.path_radius", 0, 32, best.matching.path_radius);
    read_number(config, "first_sigma", 1e-3, 10, best.first_sigma);
    read_number(config, "last_noise", 0, 100, best.last_noise);
    read_number(config, "least_sigma", 1e-3, 10, best.least_sigma);
    read_number(config, "light_offset", 1e-4, 1e3, best.light_offset);
    read_number(config, "least_light", -10, 0, best.least_light);
    read_number(config, "feedback", 0, 2, best.feedback);
    read_number(config, "feedback_kept", 0, 1, best.feedback_kept);
    read_number(config, "momentum", 0, 1, best.momentum);
    read_integer(config, "mosaic.iterations", 0, 10000, best.mosaic.iterations);
    read_number(config, "mosaic.first_sigma", 1e-3, 10, best.mosaic.first_sigma);
    read_integer(config, "mosaic.near_iterations", 0, 10000, best.mosaic.near_iterations);
    read_integer(config, "mosaic.near.slots", 0, 32, best.mosaic.near.slots);
    read_integer(config, "mosaic.near.own_radius", 0, 32, best.mosaic.near.own_radius);
    read_integer(config, "mosaic.near.path_radius", 0, 32, best.mosaic.near.path_radius);
}

}  // namespace

DecodeOptions read_decode_options(DecodeMethod method, Config& config) {
    DecodeOptions options{.method = method};
    switch (method) {
        case DecodeMethod::kNaive:
            break;
        case DecodeMethod::kFast:
            read_options(config, options.fast);
            break;
        case DecodeMethod::kPortz2013:
            read_options(config, options.portz2013);
            break;
        case DecodeMethod::kBest:
            read_options(config, options.best);
            break;
    }
    config.reject_unknown_keys();
    return options;
}

}  // namespace stipple
