#include "session/dictionary_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "io/npy_file.h"

namespace stipple {
namespace {

DictionarySettings within_memory(DictionarySettings settings) {
    const std::uint64_t patch_bytes = 2 * settings.shape.voxels() * sizeof(float) + 512;
    const auto atoms = static_cast<std::uint64_t>(settings.learning.atoms);
    check_memory(settings.patches * patch_bytes +
                     atoms * (atoms + 2 * settings.shape.voxels()) * sizeof(float),
                 Parameter{"patches"},
                 fmt::format("a dictionary of {} atoms from {} patches", atoms, settings.patches));
    return settings;
}

}  // namespace

DictionaryTraining::DictionaryTraining(DictionarySettings settings)
    : settings_(within_memory(std::move(settings))),
      training_(settings_.shape, settings_.patches, settings_.learning.seed) {}

void DictionaryTraining::add_clip(const TrainingClip& clip) {
    const auto [slots, side] = settings_.shape;
    if (std::min(clip.shape.rows, clip.shape.cols) < side)
        throw InputError(clip.name,
                         fmt::format("its frames of {} x {} are smaller than a patch of {} x {} "
                                     "pixels; give ",
                                     clip.shape.cols, clip.shape.rows, side, side) +
                             Parameter{"side"} + ", or other footage");
    if (clip.filter != ColourFilter::kNone)
        throw InputError(clip.name,
                         "is a mosaic of colours, whose neighbours differ; give footage of one "
                         "plane or three");
    if (first_clip_.empty()) first_clip_ = clip.name;
    training_.begin_clip(clip.shape);
    int frames = 0;
    for (auto frame = clip.next(); !frame.empty(); frame = clip.next(), ++frames)
        training_.add_frame(frame);
    if (frames < slots)
        throw InputError(clip.name,
                         fmt::format("has {}, a patch {}; give ", counted(frames, "frame"), slots) +
                             Parameter{"slots"} + ", or longer footage");
    frames_ += frames;
}

PatchDictionary DictionaryTraining::learn(const std::function<bool(int, double)>& keep_going) {
    patches_ = training_.patches();
    KsvdOptions learning = settings_.learning;
    if (patches_ < static_cast<std::size_t>(learning.atoms))
        throw InputError(first_clip_,
                         fmt::format("{} patches with contrast are too few for {} atoms; give "
                                     "more footage, or ",
                                     patches_, learning.atoms) +
                             Parameter{"atoms"});
    learning.keep_going = [&](int iterations, double error) {
        errors_.push_back(error);
        return keep_going(iterations, error);
    };
    const std::vector<float> patches = training_.take();
    return learn_dictionary(patches, settings_.shape, learning);
}

void write_dictionary(const PatchDictionary& dictionary, PendingOutput& output) {
    NpyWriter writer(output.partial(), output.final_path().string(),
                     {.rows = dictionary.shape.slots,
                      .cols = static_cast<int>(dictionary.shape.pixels()),
                      .planes = 1});
    for (int i = 0; i < dictionary.atoms; ++i) writer.write(dictionary.atom(i));
    writer.finish();
    output.commit();
}

}  // namespace stipple
