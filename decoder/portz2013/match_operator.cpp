#include "decoder/portz2013/match_operator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "decoder/data_prox.h"

namespace stipple {
namespace {

constexpr std::size_t kParts = 8;

std::size_t count(int n) {
    return static_cast<std::size_t>(n);
}

/// Calls body(k) for the bits that are set.
template <typename Body>
inline void for_each_bit(std::uint64_t bits, const Body& body) {
    for (; bits != 0; bits &= bits - 1) body(count(std::countr_zero(bits)));
}

/// Whether a sample is met first in slot `offset` of a patch that begins in `slot`.
bool first_seen(const TimedSample& sample, int slot, int offset) {
    return (shift_mask(sample.open_slots, slot - sample.first_slot) & lowest_bits(offset)) == 0;
}

}  // namespace

/// A row of A.
struct MatchOperator::Sampled {
    std::size_t row;
    std::size_t first;         ///< voxel of x in the sample's first slot
    std::uint64_t open_slots;  ///< which ones from there are added up
    const float* weights;      ///< of the slots from there; null without weights
    float weight;
    float light;  ///< of the sample; b = weight light
    bool saturated;

    [[nodiscard]] float apply(std::span<const float> x) const {
        float sum = 0;
        if (weights == nullptr)
            for_each_bit(open_slots, [&](std::size_t k) { sum += x[first + k]; });
        else
            for_each_bit(open_slots, [&](std::size_t k) { sum += weights[k] * x[first + k]; });
        return weight * sum;
    }
    [[nodiscard]] float residual(std::span<const float> x) const {
        return apply(x) - weight * light;
    }
    void add_adjoint(float value, std::span<float> x) const {
        const float share = weight * value;
        if (weights == nullptr)
            for_each_bit(open_slots, [&](std::size_t k) { x[first + k] += share; });
        else
            for_each_bit(open_slots, [&](std::size_t k) { x[first + k] += weights[k] * share; });
    }
    [[nodiscard]] float shrink(float v, float threshold) const {
        return saturated ? one_sided_soft_threshold(v, threshold) : soft_threshold(v, threshold);
    }
};

/// Rows of gamma F: a voxel of x in `slots` slots against another.
struct MatchOperator::Pairs {
    std::size_t row;
    std::size_t reference;
    std::size_t match;
    std::size_t slots;
    float weight;

    [[nodiscard]] float apply(std::span<const float> x, std::size_t k) const {
        return weight * (x[reference + k] - x[match + k]);
    }
    void add_adjoint(float value, std::size_t k, std::span<float> x) const {
        x[reference + k] += weight * value;
        x[match + k] -= weight * value;
    }
};

MatchOperator::MatchOperator(const ExposureTable& table, std::span<const MatchList> lists,
                             float gamma)
    : table_(table),
      lists_(lists),
      gamma_(gamma),
      voxels_(table.shape().sites() * count(table.slots())) {
    partition_groups();
}

struct MatchOperator::Match {
    const PatchPosition& i;
    const PatchMatch& j;
    PatchSize size;
};

template <typename OnSampled, typename OnPairs>
std::size_t MatchOperator::visit(const Part& part, const OnSampled& sampled,
                                 const OnPairs& pairs) const {
    std::size_t row = part.first_row;
    std::size_t before = 0;  // groups of the lists before
    for (const MatchList& list : lists_) {
        const std::size_t begin = std::clamp(part.begin, before, before + list.groups.size());
        const std::size_t end = std::clamp(part.end, before, before + list.groups.size());
        for (std::size_t g = begin - before; g < end - before; ++g)
            for (std::size_t m = list.begin_of(g); m < list.groups[g].end; ++m)
                row = visit_match({list.groups[g].reference, list.matches[m], list.size}, row,
                                  sampled, pairs);
        before += list.groups.size();
    }
    return row;
}

template <typename OnSampled, typename OnPairs>
std::size_t MatchOperator::visit_match(const Match& match, std::size_t row,
                                       const OnSampled& sampled, const OnPairs& pairs) const {
    const FrameShape shape = table_.shape();
    const auto& [i, j, size] = match;
    const int later = i.slot - j.slot;
    for (int y = 0; y < shape.planes * size.rows; ++y) {
        const int plane_row = y / size.rows * shape.rows + y % size.rows;
        std::size_t site_i = count(plane_row + i.row) * count(shape.cols) + count(i.col);
        std::size_t site_j = count(plane_row + j.row) * count(shape.cols) + count(j.col);
        for (int col = 0; col < size.cols; ++col, ++site_i, ++site_j) {
            for (int k = 0; k < size.slots; ++k) {
                const TimedSample* sample = table_.at(site_j, j.slot + k);
                if (sample == nullptr || !first_seen(*sample, j.slot, k)) continue;
                const int first = sample->first_slot + later;
                if (first < 0 || first + sample->span_slots > table_.slots()) continue;
                // tau_max / tau of the paper
                const float exposure_weight = table_.max_light_slots() / sample->light_slots;
                sampled(Sampled{row, voxel(site_i, first), sample->open_slots,
                                table_.weights(site_j, sample->first_slot),
                                j.weight * exposure_weight, sample->light, sample->saturated});
                ++row;
            }
            if (site_i == site_j && later == 0) continue;
            pairs(Pairs{row, voxel(site_i, i.slot), voxel(site_j, j.slot), count(size.slots),
                        gamma_ * j.weight});
            row += count(size.slots);
        }
    }
    return row;
}

void MatchOperator::cover(const MatchList& list, std::size_t group, Part& part) {
    const auto add = [&](int row) {
        part.top = std::min(part.top, row);
        part.bottom = std::max(part.bottom, row + list.size.rows);
    };
    add(list.groups[group].reference.row);
    for (std::size_t m = list.begin_of(group); m < list.groups[group].end; ++m)
        add(list.matches[m].row);
}

void MatchOperator::partition_groups() {
    std::size_t groups = 0, patches = 0;
    for (const MatchList& list : lists_) {
        groups += list.groups.size();
        patches += list.matches.size() * count(list.size.rows * list.size.cols * list.size.slots);
    }
    // Rows of K are numbered from part to part, which needs the number of rows of each.
    const std::size_t share = patches / kParts + 1;
    Part part{.top = std::numeric_limits<int>::max()};
    std::size_t work = 0;
    const auto close_part = [&](std::size_t end) {
        part.end = end;
        part.first_row = rows_;
        rows_ = visit(
            part, [](const Sampled&) {}, [](const Pairs&) {});
        parts_.push_back(part);
        part = {.begin = end, .top = std::numeric_limits<int>::max()};
        work = 0;
    };
    std::size_t number = 0;
    for (const MatchList& list : lists_)
        for (std::size_t g = 0; g < list.groups.size(); ++g) {
            cover(list, g, part);
            work += (list.groups[g].end - list.begin_of(g)) *
                    count(list.size.rows * list.size.cols * list.size.slots);
            ++number;
            if (work >= share || number == groups) close_part(number);
        }
}

template <typename OnPart>
void MatchOperator::for_each_part(const OnPart& on_part) {
    parallel_for(0, static_cast<int>(parts_.size()),
                 [&](int i) { on_part(parts_[count(i)], count(i)); });
}

template <typename Scatter>
void MatchOperator::accumulate(const Scatter& scatter, std::span<float> out) {
    const FrameShape shape = table_.shape();
    const std::size_t row_voxels = count(shape.cols) * count(table_.slots());
    const auto row_of = [&](int plane, int row) {
        return count(plane * shape.rows + row) * row_voxels;
    };
    for_each_part([&](Part& part, std::size_t) {
        part.sums.resize(voxels_);
        for (int plane = 0; plane < shape.planes; ++plane)
            std::fill(part.sums.begin() + static_cast<std::ptrdiff_t>(row_of(plane, part.top)),
                      part.sums.begin() + static_cast<std::ptrdiff_t>(row_of(plane, part.bottom)),
                      0.0F);
        scatter(part, std::span(part.sums));
    });
    parallel_for(0, shape.planes * shape.rows, [&](int line) {
        const std::size_t begin = count(line) * row_voxels;
        std::fill_n(&out[begin], row_voxels, 0.0F);
        for (const Part& part : parts_)
            if (line % shape.rows >= part.top && line % shape.rows < part.bottom)
                for (std::size_t i = begin; i < begin + row_voxels; ++i) out[i] += part.sums[i];
    });
}

void MatchOperator::residuals(std::span<const float> x, std::span<float> values) {
    for_each_part([&](const Part& part, std::size_t) {
        visit(
            part, [&](const Sampled& s) { values[s.row] = s.residual(x); },
            [&](const Pairs& p) {
                for (std::size_t k = 0; k < p.slots; ++k) values[p.row + k] = p.apply(x, k);
            });
    });
}

void MatchOperator::adjoint(std::span<const float> values, std::span<float> x) {
    accumulate(
        [&](const Part& part, std::span<float> sums) {
            visit(
                part, [&](const Sampled& s) { s.add_adjoint(values[s.row], sums); },
                [&](const Pairs& p) {
                    for (std::size_t k = 0; k < p.slots; ++k)
                        p.add_adjoint(values[p.row + k], k, sums);
                });
        },
        x);
}

void MatchOperator::normal(std::span<const float> x, std::span<float> out) {
    accumulate(
        [&](const Part& part, std::span<float> sums) {
            visit(
                part, [&](const Sampled& s) { s.add_adjoint(s.apply(x), sums); },
                [&](const Pairs& p) {
                    for (std::size_t k = 0; k < p.slots; ++k) p.add_adjoint(p.apply(x, k), k, sums);
                });
        },
        out);
}

void MatchOperator::start_duals(std::span<const float> x, std::span<float> v) {
    for_each_part([&](const Part& part, std::size_t) {
        visit(
            part,
            [&](const Sampled& s) { v[s.row] = s.saturated ? std::max(s.residual(x), 0.0F) : 0; },
            [&](const Pairs& p) { std::fill_n(&v[p.row], p.slots, 0.0F); });
    });
}

double MatchOperator::update_duals(std::span<const float> x, float threshold, std::span<float> v) {
    std::vector<double> objectives(parts_.size());
    for_each_part([&](const Part& part, std::size_t number) {
        double objective = 0;
        visit(
            part,
            [&](const Sampled& s) {
                const float r = s.residual(x);
                if (!s.saturated || r < 0) objective += std::abs(static_cast<double>(r));
                v[s.row] = r + (v[s.row] - s.shrink(v[s.row], threshold));
            },
            [&](const Pairs& p) {
                for (std::size_t k = 0; k < p.slots; ++k) {
                    const float r = p.apply(x, k);
                    float& value = v[p.row + k];
                    objective += std::abs(static_cast<double>(r));
                    value = r + (value - soft_threshold(value, threshold));
                }
            });
        objectives[number] = objective;
    });
    double sum = 0;
    for (const double objective : objectives) sum += objective;
    return sum;
}

void MatchOperator::right_hand_side(std::span<const float> v, float threshold, std::span<float> d) {
    accumulate(
        [&](const Part& part, std::span<float> sums) {
            visit(
                part,
                [&](const Sampled& s) {
                    const float z = s.shrink(v[s.row], threshold);
                    s.add_adjoint(s.weight * s.light + (2 * z - v[s.row]), sums);
                },
                [&](const Pairs& p) {
                    for (std::size_t k = 0; k < p.slots; ++k) {
                        const float value = v[p.row + k];
                        p.add_adjoint(2 * soft_threshold(value, threshold) - value, k, sums);
                    }
                });
        },
        d);
}

}  // namespace stipple
