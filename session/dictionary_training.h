#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "decoder/hitomi2011/ksvd.h"
#include "io/output_names.h"
#include "io/pending_output.h"

namespace stipple {

/// What a dictionary is to be, and how it is learnt.
struct DictionarySettings {
    static constexpr int kMaxSidePx = 32, kMaxAtoms = 16384, kMaxSparsity = 64;
    static constexpr int kMaxIterations = 1000;
    static constexpr std::uint64_t kMaxPatches = 10'000'000;

    AtomShape shape{.slots = 8, .side_px = 7};
    std::uint64_t patches = 20000;  ///< max patches to learn from
    KsvdOptions learning = {};
};

/// A clip to learn from, read once.
struct TrainingClip {
    std::string name;  ///< for messages
    FrameShape shape;
    ColourFilter filter = ColourFilter::kNone;
    /// The next frame, order (plane, row, col), or empty at the end; what it throws ends the call.
    std::function<std::span<const float>()> next;
};

/// Learns a dictionary for the method hitomi2011: footage first, then `learn`. Command and Python
/// make the same bytes with it.
class DictionaryTraining {
  public:
    /// \throws InputError as check_memory.
    explicit DictionaryTraining(DictionarySettings settings);

    /// Takes patches of a clip. \throws InputError if it has frames that are smaller than a patch,
    /// a mosaic of colours, or fewer frames than a patch has slots.
    void add_clip(const TrainingClip& clip);

    /// Once, after the clips. `keep_going` as that of KsvdOptions. \throws InputError if there are
    /// fewer patches with contrast than atoms.
    [[nodiscard]] PatchDictionary learn(const std::function<bool(int, double)>& keep_going);

    /// Calls add(name, value) for each figure of what was learnt (docs/outputs.md).
    template <typename Add>
    void visit_figures(const Add& add) const {
        add("atoms", settings_.learning.atoms);
        add("slots", settings_.shape.slots);
        add("side", settings_.shape.side_px);
        add("frames", frames_);
        add("patches", patches_);
        add("errors", errors_);
    }

  private:
    DictionarySettings settings_;
    TrainingPatches training_;
    std::string first_clip_;
    int frames_ = 0;
    std::size_t patches_ = 0;
    std::vector<double> errors_;  ///< after each iteration
};

inline constexpr OutputName kDictionaryName{
    "a dictionary is a .npy, or has a name without extension", {".npy"}};

/// Writes the array (atom, slot, pixel) as a .npy and commits it. \throws DeviceError.
void write_dictionary(const PatchDictionary& dictionary, PendingOutput& output);

}  // namespace stipple
