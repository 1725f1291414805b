#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "decoder/portz2013/exposure_table.h"
#include "decoder/portz2013/patch_matches.h"

namespace stipple {

/// K = [A; gamma F] of Eq. 4 of Portz et al. 2013, never stored: its rows are computed from the
/// match lists each time it is applied. For each match j of a reference patch i,
///   A: for each sample of patch j, w_ij tau_max / tau times the sum of x over the sample's open
///      slots, at the position and time of patch i; b = w_ij tau_max / tau times the sample.
///      Rows that reach beyond the block are omitted;
///   gamma F: gamma w_ij (x_i - x_j) for each voxel of the patches.
/// x has the order (plane, row, col, slot), so that the data of a row are adjacent. All results
/// have the same bits for any number of threads: the groups are divided into a fixed number of
/// parts, whose sums are added in a fixed order.
class MatchOperator {
  public:
    /// `table` and `lists` must outlive it.
    MatchOperator(const ExposureTable& table, std::span<const MatchList> lists, float gamma);

    [[nodiscard]] std::size_t rows() const { return rows_; }
    [[nodiscard]] std::size_t voxels() const { return voxels_; }

    /// out = K^T K x
    void normal(std::span<const float> x, std::span<float> out);
    /// The factors of `normal`, called by tests alone: values = K x - [b; 0] and x = K^T values.
    void residuals(std::span<const float> x, std::span<float> values);
    void adjoint(std::span<const float> values, std::span<float> x);

    // The steps of Algorithm 1 for z and u. Both are stored as v = r + u: z is the soft threshold
    // of v (one-sided for saturated samples), and u = v - z.

    /// v for z = u = 0, except for saturated samples that x explains: their z is the residual.
    void start_duals(std::span<const float> x, std::span<float> v);
    /// v = K x - [b; 0] + u. Returns the objective (Eq. 4) of x.
    double update_duals(std::span<const float> x, float threshold, std::span<float> v);
    /// d = K^T([b; 0] + z - u)
    void right_hand_side(std::span<const float> v, float threshold, std::span<float> d);

  private:
    struct Sampled;
    struct Pairs;
    struct Match;
    /// Groups [begin, end) of all lists in sequence, their rows of K from `first_row`, and the rows
    /// of the frame that they contain.
    struct Part {
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t first_row = 0;
        int top = 0;
        int bottom = 0;
        std::vector<float> sums = {};
    };

    [[nodiscard]] std::size_t voxel(std::size_t site, int slot) const {
        return site * static_cast<std::size_t>(table_.slots()) + static_cast<std::size_t>(slot);
    }
    /// Calls sampled(Sampled) and pairs(Pairs) for all rows of the groups, in the order of the
    /// rows.
    template <typename OnSampled, typename OnPairs>
    std::size_t visit(const Part& part, const OnSampled& sampled, const OnPairs& pairs) const;
    /// The rows of one match, from number `row`; returns the number after the last one.
    template <typename OnSampled, typename OnPairs>
    std::size_t visit_match(const Match& match, std::size_t row, const OnSampled& sampled,
                            const OnPairs& pairs) const;
    /// out = the sum over all parts of the sums that scatter(part, sums) adds to zeros.
    template <typename Scatter>
    void accumulate(const Scatter& scatter, std::span<float> out);
    template <typename OnPart>
    void for_each_part(const OnPart& on_part);
    /// Extends the rows of the frame in `part` by those of a group.
    static void cover(const MatchList& list, std::size_t group, Part& part);
    void partition_groups();

    const ExposureTable& table_;
    std::span<const MatchList> lists_;
    float gamma_;
    std::size_t voxels_ = 0;
    std::size_t rows_ = 0;
    std::vector<Part> parts_;
};

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
