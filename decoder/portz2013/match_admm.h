#pragma once

#include <functional>
#include <span>

#include "decoder/portz2013/match_operator.h"

namespace stipple {

/// Receives the objective (Eq. 4) after each iteration; false stops.
using AfterAdmmIteration = std::function<bool(int iteration, double objective)>;

/// Minimises ||A x - b||_1* + gamma ||F x||_1 from the start x by Algorithm 1 of Portz et al. 2013:
/// M^-1 by conjugate gradients from the last x, with M = K^T K applied and never formed. x has the
/// order of `problem`. `progress` is also called between iterations of conjugate gradients. The
/// same bits for any number of threads. Memory: 4 bytes per row of K, 52 per voxel.
void minimise_by_admm(MatchOperator& problem, const MatchAdmmOptions& options,
                      const AfterAdmmIteration& after_iteration,
                      const std::function<bool()>& progress, std::span<float> x);

}  // namespace stipple
