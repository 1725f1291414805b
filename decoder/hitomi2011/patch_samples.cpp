#include "decoder/hitomi2011/patch_samples.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>

#include "decoder/measurements.h"

namespace stipple {
namespace {

/// to += factor * from
void add(float factor, std::span<const float> from, std::span<float> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// Calls body(slots after the first one, weight) for the open slots of a sample; `weights` null: 1.
template <typename Body>
void for_each_open_slot(const TimedSample& sample, const float* weights, const Body& body) {
    for (int i = 0; i < sample.span_slots; ++i)
        if ((sample.open_slots >> static_cast<unsigned>(i) & 1U) != 0)
            body(i, weights == nullptr ? 1 : weights[i]);
}

}  // namespace

/// The samples of a patch, and the atoms sampled alike.
class PatchSamples::SampledAtoms {
  public:
    explicit SampledAtoms(int atoms) : atoms_(index(atoms)) {}

    /// A sample divided by the norm of its weights. Returns the row of its atoms, 0 as yet.
    std::span<float> add_sample(float light, float variance, bool saturated) {
        samples_.push_back({.light = light, .variance = variance, .saturated = saturated});
        matrix_.resize(samples_.size() * atoms_);
        return std::span(matrix_).last(atoms_);
    }

    [[nodiscard]] SparseCode code(const CodingLimits& limits) {
        const bool bounds_only = std::ranges::all_of(samples_, &Sample::saturated);
        for (Sample& sample : samples_) sample.active = bounds_only || !sample.saturated;
        SparseCode code = code_of_active(limits);
        constexpr int kRounds = 4;
        for (int round = 0; round < kRounds && activate_violated(code); ++round)
            code = code_of_active(limits);
        return code;
    }

  private:
    struct Sample {
        float light;
        float variance;
        bool saturated;  ///< `light` is a lower bound
        bool active = true;
    };

    [[nodiscard]] std::span<const float> row(std::size_t sample) const {
        return std::span(matrix_).subspan(sample * atoms_, atoms_);
    }
    template <typename Body>
    void for_each_active(const Body& body) const {
        for (std::size_t i = 0; i < samples_.size(); ++i)
            if (samples_[i].active) body(samples_[i], row(i));
    }

    /// Bounds that the code violates take part, others do not. False if nothing changes.
    bool activate_violated(const SparseCode& code) {
        bool changed = false;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            Sample& sample = samples_[i];
            if (!sample.saturated) continue;
            float light = 0;
            for (std::size_t k = 0; k < code.atoms.size(); ++k)
                light += code.weights[k] * row(i)[index(code.atoms[k])];
            const bool violated = light < sample.light;
            // An active bound is met up to what the pursuit leaves, so it stays while it pulls up.
            const bool active = violated || (sample.active && light < 1.01F * sample.light);
            changed = changed || active != sample.active;
            sample.active = active;
        }
        return changed;
    }

    [[nodiscard]] SparseCode code_of_active(const CodingLimits& limits) const {
        std::vector<float> correlations(atoms_);
        std::vector<float> norms(atoms_);
        double energy = 0;
        double noise = 0;
        int samples = 0;
        for_each_active([&](const Sample& sample, std::span<const float> values) {
            add(sample.light, values, correlations);
            for (std::size_t j = 0; j < atoms_; ++j) norms[j] += values[j] * values[j];
            energy += static_cast<double>(sample.light) * static_cast<double>(sample.light);
            noise += static_cast<double>(sample.variance);
            ++samples;
        });
        std::deque<std::vector<float>> products;  // keeps its elements in place
        const PursuitProblem problem{
            .correlations = correlations,
            .norms = norms,
            .energy = energy,
            .gram = [&](int atom) -> std::span<const float> {
                std::vector<float>& to = products.emplace_back(atoms_);
                for_each_active([&](const Sample&, std::span<const float> values) {
                    add(values[index(atom)], values, to);
                });
                return to;
            }};
        return pursue(problem, {.max_atoms = std::min(limits.max_atoms, samples),
                                .max_error = limits.noise_factor * limits.noise_factor * noise});
    }

    std::size_t atoms_;
    std::vector<Sample> samples_;
    std::vector<float> matrix_;  ///< order (sample, atom)
};

PatchSamples::PatchSamples(const Measurements& measurements, const PatchDictionary& dictionary)
    : measurements_(measurements),
      dictionary_(dictionary),
      table_(measurements),
      by_voxel_(dictionary.by_voxel()) {}

std::vector<std::size_t> PatchSamples::exposures_by_first_slot() const {
    const std::size_t sites = measurements_.shape.sites();
    std::vector<std::size_t> counts(index(table_.slots()));
    for (std::size_t site = 0; site < sites; ++site)
        for (int slot = 0; slot < table_.slots(); ++slot) {
            const TimedSample* sample = table_.at(site, slot);
            if (sample == nullptr || sample->first_slot != slot) continue;
            const int end = slot + sample->span_slots;
            for (int first = std::max(end - dictionary_.shape.slots, 0); first <= slot; ++first)
                ++counts[index(first)];
        }
    return counts;
}

PatchSamples::SampledAtoms PatchSamples::sampled_atoms(const AtomPosition& at) const {
    const AtomShape& shape = dictionary_.shape;
    const FrameShape frame = measurements_.shape;
    const std::size_t atoms = index(dictionary_.atoms);
    SampledAtoms sampled(dictionary_.atoms);
    const auto add_sample = [&](const TimedSample& sample, std::size_t site, std::size_t pixel) {
        const float* weights = table_.weights(site, sample.first_slot);
        float square = 0;
        for_each_open_slot(sample, weights, [&](int, float w) { square += w * w; });
        const float scale = 1 / std::sqrt(square);
        const std::size_t last = index(sample.first_slot + sample.span_slots - 1);
        const float variance = measurements_.variance[last * frame.sites() + site];
        const auto row =
            sampled.add_sample(scale * sample.light, scale * scale * variance, sample.saturated);
        for_each_open_slot(sample, weights, [&](int i, float w) {
            const std::size_t voxel =
                index(sample.first_slot + i - at.slot) * shape.pixels() + pixel;
            add(scale * w, std::span(by_voxel_).subspan(voxel * atoms, atoms), row);
        });
    };
    const int rows = std::min(shape.side_px, frame.rows - at.row);
    const int cols = std::min(shape.side_px, frame.cols - at.col);
    const int end = std::min(at.slot + shape.slots, table_.slots());
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const std::size_t site = index(at.plane) * frame.pixels() +
                                     row_major(at.row + row, at.col + col, frame.cols);
            for (int slot = at.slot; slot < end; ++slot) {
                const TimedSample* sample = table_.at(site, slot);
                if (sample != nullptr && sample->first_slot == slot &&
                    slot + sample->span_slots <= end)
                    add_sample(*sample, site, row_major(row, col, shape.side_px));
            }
        }
    return sampled;
}

SparseCode PatchSamples::code(const AtomPosition& at, const CodingLimits& limits) const {
    return sampled_atoms(at).code(limits);
}

}  // namespace stipple
