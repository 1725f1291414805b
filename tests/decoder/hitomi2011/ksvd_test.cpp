#include "decoder/hitomi2011/ksvd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/parallel.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr AtomShape kShape{.slots = 4, .side_px = 3};

/// Patches that are sums of 1 and two atoms of a dictionary.
std::vector<float> sums_of(const PatchDictionary& d, std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> patches(count * d.shape.voxels(), 1.0F);
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < 2; ++k) {
            const auto atom =
                d.atom(1 + static_cast<int>(random() % static_cast<unsigned>(d.atoms - 1)));
            const float weight = (random() % 2 == 0 ? 1.0F : -1.0F) *
                                 (1 + static_cast<float>(random() % 1000) / 1000);
            for (std::size_t v = 0; v < atom.size(); ++v)
                patches[i * atom.size() + v] += weight * atom[v];
        }
    return patches;
}

TEST(KsvdTest, TheErrorNeverIncreases) {
    const auto patches = random_values(400 * kShape.voxels(), 0, 2, 1);
    std::vector<double> errors;
    KsvdOptions options{.atoms = 50, .sparsity = 4, .iterations = 15};
    options.keep_going = [&](int, double error) {
        errors.push_back(error);
        return true;
    };
    const PatchDictionary d = learn_dictionary(patches, kShape, options);
    ASSERT_EQ(errors.size(), 15U);
    for (std::size_t i = 1; i < errors.size(); ++i)
        EXPECT_LE(errors[i], errors[i - 1] * (1 + 1e-6));
    EXPECT_LT(errors.back(), 0.95 * errors.front());
    for (int i = 0; i < d.atoms; ++i) EXPECT_NEAR(dot(d.atom(i), d.atom(i)), 1, 1e-5);
    for (const float value : d.atom(0)) EXPECT_EQ(value, d.atom(0)[0]);
}

TEST(KsvdTest, FindsTheAtomsThatPatchesAreMadeOf) {
    const PatchDictionary truth = cosine_dictionary(kShape, 2);  // 10 atoms
    const auto patches = sums_of(truth, 500, 1);
    const PatchDictionary d =
        learn_dictionary(patches, kShape, {.atoms = 14, .sparsity = 3, .iterations = 40});
    int found = 0;
    for (int i = 1; i < truth.atoms; ++i)
        for (int j = 1; j < d.atoms; ++j)
            if (std::abs(dot(truth.atom(i), d.atom(j))) > 0.99) {
                ++found;
                break;
            }
    EXPECT_EQ(found, truth.atoms - 1);
}

TEST(KsvdTest, BitsDoNotDependOnThreadsButOnTheSeed) {
    const auto patches = random_values(300 * kShape.voxels(), 0, 2, 3);
    const auto learned = [&](int threads, std::uint64_t seed) {
        const ThreadLimit limit(threads);
        return learn_dictionary(patches, kShape,
                                {.atoms = 40, .sparsity = 5, .iterations = 4, .seed = seed})
            .values;
    };
    const auto one = learned(1, 1);
    EXPECT_EQ(one, learned(3, 1));
    EXPECT_NE(one, learned(1, 2));
}

// More atoms than the patches differ: those without a use are replaced, none is undefined.
TEST(KsvdTest, EqualPatchesLeaveFiniteAtoms) {
    std::vector<float> patches(40 * kShape.voxels(), 1.0F);
    for (std::size_t i = 0; i < patches.size(); i += 2) patches[i] = 0.5F;
    const PatchDictionary d = learn_dictionary(patches, kShape, {.atoms = 20, .iterations = 3});
    EXPECT_TRUE(std::ranges::all_of(d.values, [](float v) { return std::isfinite(v); }));
}

}  // namespace
}  // namespace stipple
