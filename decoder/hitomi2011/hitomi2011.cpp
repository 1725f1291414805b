#include "decoder/hitomi2011/hitomi2011.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "decoder/hitomi2011/patch_samples.h"
#include "decoder/measurements.h"
#include "decoder/mosaic_hues.h"
#include "decoder/naive/nearest_samples.h"

namespace stipple {
namespace {

constexpr auto kDictionary = "decoder.dictionary";

/// First positions of patches along an axis, the last one at its end.
std::vector<int> positions(int length, int side, int step) {
    std::vector<int> list;
    for (int at = 0; at + side < length; at += step) list.push_back(at);
    list.push_back(std::max(length - side, 0));
    return list;
}

/// Patches that begin in a slot, and the slots that they decide.
struct Layer {
    int first_slot;
    int begin;
    int end;
};

/// Layers every `step` slots, where a layer holds the most samples; further ones decide the slots
/// at the ends of the block, if they hold samples.
std::vector<Layer> layers_of(const std::vector<std::size_t>& samples, int patch_slots, int step) {
    const auto slots = static_cast<int>(samples.size());
    const int last = std::max(slots - patch_slots, 0);
    int best = 0;
    std::size_t most = 0;  // in `layers_of_most` layers
    std::size_t layers_of_most = 1;
    for (int offset = 0; offset < step && offset <= last; ++offset) {
        std::size_t sum = 0;
        std::size_t count = 0;
        for (int at = offset; at <= last; at += step, ++count) sum += samples[index(at)];
        if (sum * layers_of_most > most * count) {
            most = sum;
            layers_of_most = count;
            best = offset;
        }
    }
    std::vector<Layer> layers;
    for (int at = best; at <= last; at += step)
        layers.push_back({at, at, std::min(at + patch_slots, slots)});
    const int end = layers.back().end;
    if (best > 0) layers.push_back({0, 0, best});
    if (end < slots) layers.push_back({last, end, slots});
    std::erase_if(layers,
                  [&](const Layer& layer) { return samples[index(layer.first_slot)] == 0; });
    return layers;
}

/// Sums of patches over the voxels of a block.
class Decoder {
  public:
    Decoder(const Measurements& measurements, const Hitomi2011Options& options)
        : options_(options),
          samples_(measurements, options.dictionary),
          sums_(measurements.slots, measurements.shape),
          counts_(measurements.slots, measurements.shape) {}

    [[nodiscard]] std::vector<Layer> layers() const {
        const int patch_slots = options_.dictionary.shape.slots;
        const auto samples = samples_.exposures_by_first_slot();
        return layers_of(samples, patch_slots,
                         options_.step_slots > 0 ? options_.step_slots : patch_slots);
    }

    void add(const Layer& layer) {
        const FrameShape shape = sums_.shape();
        const int side = options_.dictionary.shape.side_px;
        const std::vector<int> rows = positions(shape.rows, side, options_.step_px);
        const std::vector<int> cols = positions(shape.cols, side, options_.step_px);
        for (int plane = 0; plane < shape.planes; ++plane) {
            std::vector<std::vector<SparseCode>> codes(rows.size());
            parallel_for(0, static_cast<int>(rows.size()), [&](int i) {
                for (const int col : cols)
                    codes[index(i)].push_back(samples_.code(
                        {layer.first_slot, plane, rows[index(i)], col},
                        {options_.max_atoms, static_cast<double>(options_.noise_factor)}));
            });
            parallel_for(layer.begin, layer.end, [&](int slot) {
                for (std::size_t i = 0; i < rows.size(); ++i)
                    for (std::size_t j = 0; j < cols.size(); ++j)
                        add_slot(codes[i][j], {slot - layer.first_slot, plane, rows[i], cols[j]},
                                 slot);
            });
        }
    }

    /// The means of the patches; x where there is none.
    void write_means(FluxVideo& x) const {
        parallel_for(0, x.slots(), [&](int slot) {
            for (std::size_t i = 0; i < x.shape().sites(); ++i)
                if (const float count = counts_.frame(slot)[i]; count > 0)
                    x.frame(slot)[i] = sums_.frame(slot)[i] / count;
        });
    }

  private:
    /// Adds slot `at.slot` of the patch to a slot of the block.
    void add_slot(const SparseCode& code, const AtomPosition& at, int slot) {
        if (code.atoms.empty()) return;
        const AtomShape& shape = options_.dictionary.shape;
        std::vector<float> light(shape.pixels());
        for (std::size_t k = 0; k < code.atoms.size(); ++k) {
            const auto atom = options_.dictionary.atom(code.atoms[k])
                                  .subspan(index(at.slot) * shape.pixels(), shape.pixels());
            for (std::size_t i = 0; i < light.size(); ++i) light[i] += code.weights[k] * atom[i];
        }
        const PlaneView<float> sums = sums_.plane(slot, at.plane);
        const PlaneView<float> counts = counts_.plane(slot, at.plane);
        const int rows = std::min(shape.side_px, sums.rows() - at.row);
        const int cols = std::min(shape.side_px, sums.cols() - at.col);
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col) {
                sums(at.row + row, at.col + col) += light[row_major(row, col, shape.side_px)];
                counts(at.row + row, at.col + col) += 1;
            }
    }

    const Hitomi2011Options& options_;
    PatchSamples samples_;
    FluxVideo sums_;
    FluxVideo counts_;
};

bool has_samples(const Measurements& m) {
    return std::ranges::any_of(
        m.state, [](std::uint8_t state) { return (state & Measurements::kLast) != 0; });
}

}  // namespace

std::optional<FluxVideo> decode_hitomi2011(const Measurements& measurements,
                                           const Hitomi2011Options& options,
                                           const ProgressCallback& progress) {
    if (options.dictionary.atoms == 0)
        throw InputError(Parameter{kDictionary},
                         "method hitomi2011 needs a dictionary of patches; the command \"stipple "
                         "dictionary\" learns one from footage");
    if (measurements.mosaic)
        return decode_by_hue(measurements, {}, [&](const auto& mean, const auto&) {
            return decode_hitomi2011(mean, options, progress);
        });
    FluxVideo x = nearest_samples(measurements);
    Decoder decoder(measurements, options);
    const std::vector<Layer> layers = decoder.layers();
    if (layers.empty() && has_samples(measurements))
        throw InputError(Parameter{kDictionary},
                         fmt::format("its patches of {} slots are shorter than all exposures; "
                                     "learn one whose patches have the period of the schedule",
                                     options.dictionary.shape.slots));
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (!progress(static_cast<double>(i) / static_cast<double>(layers.size()))) return {};
        decoder.add(layers[i]);
    }
    decoder.write_means(x);
    return x;
}

void read_options(Config& config, Hitomi2011Options& options) {
    const KeyReader read(config);
    read({.name = "dictionary", .text = "file of \"stipple dictionary\""}, options.dictionary_file);
    read({"step_px", {1, 64}, "pixels", "stride of patches in rows and columns"}, options.step_px);
    read({"step_slots", {0, 64}, "slots", "stride of patches in time; 0: their length"},
         options.step_slots);
    read({"max_atoms", {1, 1000}, "", "max atoms of a patch"}, options.max_atoms);
    read({"noise_factor", {0, 1e3}, "", "the pursuit ends at the noise times this"},
         options.noise_factor);
}

}  // namespace stipple
