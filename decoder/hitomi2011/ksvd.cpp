#include "decoder/hitomi2011/ksvd.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "core/philox.h"
#include "decoder/hitomi2011/matching_pursuit.h"

namespace stipple {
namespace {

double square_of(std::span<const float> values) {
    double sum = 0;
    for (const float value : values) sum += static_cast<double>(value) * static_cast<double>(value);
    return sum;
}

double dot(std::span<const float> a, std::span<const float> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

/// to += factor * from
void add(float factor, std::span<const float> from, std::span<float> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

void scale_to_norm_1(std::span<float> atom) {
    const double norm = std::sqrt(square_of(atom));
    for (float& value : atom) value = static_cast<float>(static_cast<double>(value) / norm);
}

/// So many different numbers below `count`, by swaps (Fisher and Yates).
std::vector<std::size_t> drawn(std::size_t count, std::size_t number, std::uint64_t seed) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i < number; ++i) {
        const auto random = philox4x32({static_cast<std::uint32_t>(i), 0, 2, 0}, seed);
        const std::uint64_t word = std::uint64_t{random[0]} << 32U | random[1];
        std::swap(order[i], order[i + word % (count - i)]);
    }
    order.resize(number);
    return order;
}

class Learner {
  public:
    Learner(std::span<const float> patches, AtomShape shape, const KsvdOptions& options)
        : patches_(patches),
          voxels_(shape.voxels()),
          options_(options),
          dictionary_{.shape = shape,
                      .atoms = options.atoms,
                      .values = std::vector<float>(index(options.atoms) * shape.voxels())},
          residuals_(patches.begin(), patches.end()),
          codes_(patches.size() / shape.voxels()) {
        start();
    }

    PatchDictionary learn() {
        for (int i = 0; i < options_.iterations; ++i) {
            code_patches();
            sort_patches_by_atom();
            for (int atom = 1; atom < options_.atoms; ++atom) update(atom);
            if (!options_.keep_going(i + 1, error())) break;
        }
        return std::move(dictionary_);
    }

  private:
    /// A patch that uses an atom, and the place of the atom in its code.
    struct Use {
        std::size_t patch;
        std::size_t place;
    };

    void start() {
        std::ranges::fill(atom(0), 1.0F);
        const auto chosen = drawn(codes_.size(), index(options_.atoms) - 1, options_.seed);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const auto to = atom(static_cast<int>(i) + 1);
            std::ranges::copy(patch(chosen[i]), to.begin());
            const double mean =
                std::accumulate(to.begin(), to.end(), 0.0) / static_cast<double>(voxels_);
            for (float& value : to) value -= static_cast<float>(mean);
            if (square_of(to) == 0) to[0] = 1;  // of a patch without contrast
        }
        for (int i = 0; i < options_.atoms; ++i) scale_to_norm_1(atom(i));
    }

    [[nodiscard]] std::span<float> atom(int number) {
        return std::span(dictionary_.values).subspan(index(number) * voxels_, voxels_);
    }
    [[nodiscard]] std::span<const float> patch(std::size_t i) const {
        return patches_.subspan(i * voxels_, voxels_);
    }
    [[nodiscard]] std::span<float> residual(std::size_t i) {
        return std::span(residuals_).subspan(i * voxels_, voxels_);
    }

    void code_patches() {
        const std::size_t atoms = index(options_.atoms);
        const std::vector<float> by_voxel = dictionary_.by_voxel();
        const auto correlations = [&](std::span<const float> signal, std::span<float> to) {
            std::ranges::fill(to, 0.0F);
            for (std::size_t v = 0; v < voxels_; ++v)
                add(signal[v], std::span(by_voxel).subspan(v * atoms, atoms), to);
        };
        std::vector<float> gram(atoms * atoms);
        std::vector<float> norms(atoms);
        parallel_for(0, options_.atoms, [&](int i) {
            correlations(atom(i), std::span(gram).subspan(index(i) * atoms, atoms));
            norms[index(i)] = gram[index(i) * atoms + index(i)];
        });
        parallel_for(0, static_cast<int>(codes_.size()), [&](int i) {
            std::vector<float> products(atoms);
            correlations(patch(index(i)), products);
            const PursuitProblem problem{.correlations = products,
                                         .norms = norms,
                                         .energy = square_of(patch(index(i))),
                                         .gram = [&](int j) -> std::span<const float> {
                                             return std::span(gram).subspan(index(j) * atoms,
                                                                            atoms);
                                         }};
            take_better(index(i), pursue(problem, {.max_atoms = options_.sparsity}));
        });
    }

    void take_better(std::size_t i, SparseCode code) {
        std::vector<float> rest(patch(i).begin(), patch(i).end());
        for (std::size_t k = 0; k < code.atoms.size(); ++k)
            add(-code.weights[k], dictionary_.atom(code.atoms[k]), rest);
        if (square_of(rest) > square_of(residual(i))) return;
        std::ranges::copy(rest, residual(i).begin());
        codes_[i] = std::move(code);
    }

    void sort_patches_by_atom() {
        uses_.assign(index(options_.atoms), {});
        for (std::size_t i = 0; i < codes_.size(); ++i)
            for (std::size_t k = 0; k < codes_[i].atoms.size(); ++k)
                uses_[index(codes_[i].atoms[k])].push_back({i, k});
        by_error_.clear();
    }

    void update(int number) {
        const auto& uses = uses_[index(number)];
        if (uses.empty()) return replace(number);
        constexpr int kSteps = 2;
        for (int step = 0; step < kSteps; ++step) {
            const std::vector<float> old(atom(number).begin(), atom(number).end());
            if (!fit_atom(number, uses)) return;
            fit_weights(number, uses, old);
        }
    }

    [[nodiscard]] float& weight(const Use& use) { return codes_[use.patch].weights[use.place]; }

    /// The atom that best explains what the others leave, with the present weights: the sum of
    /// w (r + w d), scaled to norm 1. False if that is 0.
    bool fit_atom(int number, const std::vector<Use>& uses) {
        double squares = 0;
        for (const Use& use : uses) squares += static_cast<double>(weight(use) * weight(use));
        std::vector<double> sums(voxels_);
        constexpr std::size_t kChunk = 64;
        parallel_for(0, static_cast<int>((voxels_ + kChunk - 1) / kChunk), [&](int chunk) {
            const std::size_t begin = index(chunk) * kChunk;
            const std::size_t end = std::min(begin + kChunk, voxels_);
            for (const Use& use : uses) {
                const float w = weight(use);
                const auto rest = residual(use.patch);
                for (std::size_t v = begin; v < end; ++v)
                    sums[v] += static_cast<double>(w) * static_cast<double>(rest[v]);
            }
            for (std::size_t v = begin; v < end; ++v)
                sums[v] += squares * static_cast<double>(atom(number)[v]);
        });
        double norm = 0;
        for (const double sum : sums) norm += sum * sum;
        if (!(norm > 0)) return false;
        norm = std::sqrt(norm);
        for (std::size_t v = 0; v < voxels_; ++v)
            atom(number)[v] = static_cast<float>(sums[v] / norm);
        return true;
    }

    /// The weights that best explain what the others leave, with the present atom.
    void fit_weights(int number, const std::vector<Use>& uses, std::span<const float> old_atom) {
        parallel_for(0, static_cast<int>(uses.size()), [&](int i) {
            const Use& use = uses[index(i)];
            const auto rest = residual(use.patch);
            add(weight(use), old_atom, rest);
            weight(use) = static_cast<float>(dot(rest, atom(number)));
            add(-weight(use), atom(number), rest);
        });
    }

    /// By the residual of the worst patch that has replaced none.
    void replace(int number) {
        if (by_error_.empty()) {
            std::vector<double> errors;
            for (std::size_t i = 0; i < codes_.size(); ++i)
                errors.push_back(square_of(residual(i)));
            by_error_.resize(codes_.size());
            std::iota(by_error_.begin(), by_error_.end(), std::size_t{0});
            std::ranges::stable_sort(
                by_error_, [&](std::size_t a, std::size_t b) { return errors[a] < errors[b]; });
        }
        const auto rest = residual(by_error_.back());
        if (square_of(rest) > 0) {
            std::ranges::copy(rest, atom(number).begin());
            scale_to_norm_1(atom(number));
        }
        if (by_error_.size() > 1) by_error_.pop_back();
    }

    [[nodiscard]] double error() const {
        return std::sqrt(square_of(residuals_) / static_cast<double>(residuals_.size()));
    }

    std::span<const float> patches_;
    std::size_t voxels_;
    const KsvdOptions& options_;
    PatchDictionary dictionary_;
    std::vector<float> residuals_;  ///< of each patch
    std::vector<SparseCode> codes_;
    std::vector<std::vector<Use>> uses_;  ///< of each atom
    std::vector<std::size_t> by_error_;   ///< patches, the worst last
};

}  // namespace

PatchDictionary learn_dictionary(std::span<const float> patches, AtomShape shape,
                                 const KsvdOptions& options) {
    assert(options.atoms >= 1 && patches.size() >= index(options.atoms) * shape.voxels());
    return Learner(patches, shape, options).learn();
}

}  // namespace stipple
