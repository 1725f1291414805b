#include "session/dictionary_training.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 12, .cols = 10, .planes = 1};

/// A clip of waves; `frame` outlives it.
TrainingClip waves(int frames, std::vector<float>& frame) {
    frame.resize(kShape.sites());
    return {.name = "waves", .shape = kShape, .next = [&frame, frames, slot = 0]() mutable {
                if (slot == frames) return std::span<const float>();
                for (std::size_t i = 0; i < frame.size(); ++i)
                    frame[i] = 1 + 0.5F * std::sin(0.7F * static_cast<float>(i % 10) +
                                                   static_cast<float>(slot));
                ++slot;
                return std::span<const float>(frame);
            }};
}

DictionarySettings small() {
    DictionarySettings settings{.shape = {.slots = 4, .side_px = 3}, .patches = 100};
    settings.learning.atoms = 8;
    settings.learning.iterations = 3;
    return settings;
}

TEST(DictionaryTrainingTest, LearnsAtomsOfNormOne) {
    DictionaryTraining training(small());
    std::vector<float> frame;
    training.add_clip(waves(9, frame));
    int calls = 0;
    const PatchDictionary dictionary = training.learn([&](int, double) { return ++calls < 9; });
    EXPECT_EQ(calls, 3);
    ASSERT_EQ(dictionary.atoms, 8);
    for (int i = 0; i < dictionary.atoms; ++i) {
        double norm = 0;
        for (const float value : dictionary.atom(i)) norm += static_cast<double>(value * value);
        EXPECT_NEAR(norm, 1, 1e-5);
    }
    const TemporaryFolder folder;
    PendingOutput output(folder / "d.npy", false);
    write_dictionary(dictionary, output);
    EXPECT_EQ(folder.names(), std::vector<std::string>{"d.npy"});
}

TEST(DictionaryTrainingTest, NamesFootageThatIsTooShortOrSmall) {
    std::vector<float> frame;
    const auto problem = [&](int frames, DictionarySettings settings) {
        return message_of<InputError>([&] {
            DictionaryTraining training(settings);
            training.add_clip(waves(frames, frame));
            return training.learn([](int, double) { return true; });
        });
    };
    expect_parts(problem(3, small()), {"waves: has 3 frames, a patch 4"});
    DictionarySettings large = small();
    large.shape.side_px = 11;
    expect_parts(problem(9, large), {"waves: ", "smaller than a patch of 11 x 11"});
    DictionarySettings many = small();
    many.learning.atoms = 101;
    expect_parts(problem(9, many), {"waves: 100 patches with contrast are too few for 101 atoms"});
}

}  // namespace
}  // namespace stipple
