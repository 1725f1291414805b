#include "decoder/hitomi2011/patch_dictionary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/decoder/hitomi2011/cosine_dictionary.h"
#include "tests/decoder/recordings.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(PatchDictionaryTest, AtomsHaveNorm1) {
    const std::vector<double> values{3, 0, 0, 4, 1e300, 1e300, 1e300, 1e300};
    const PatchDictionary dictionary = patch_dictionary({2, 1, 4}, values, "here");
    EXPECT_EQ(dictionary.shape, (AtomShape{.slots = 1, .side_px = 2}));
    const std::vector<float> expected{0.6F, 0, 0, 0.8F, 0.5F, 0.5F, 0.5F, 0.5F};
    EXPECT_EQ(dictionary.values, expected);
    const std::vector<float> by_voxel{0.6F, 0.5F, 0, 0.5F, 0, 0.5F, 0.8F, 0.5F};
    EXPECT_EQ(dictionary.by_voxel(), by_voxel);
}

TEST(PatchDictionaryTest, RefusesWhatIsNone) {
    const auto problem = [](const ArrayShape& shape, std::vector<double> values) {
        return message_of<InputError>(
            [&] { static_cast<void>(patch_dictionary(shape, values, "d.npy")); });
    };
    expect_parts(problem({1, 1, 5}, std::vector<double>(5, 1)),
                 {"d.npy", "1 x 1 x 5", "square", "stipple dictionary"});
    expect_parts(problem({1, 65, 1}, std::vector<double>(65, 1)), {"1..64 slots"});
    expect_parts(problem({2, 1, 1}, {1, 0}), {"atom 1", "is 0"});
    expect_parts(problem({2, 1, 1}, {1, std::numeric_limits<double>::infinity()}),
                 {"atom 1", "inf", "finite"});
}

TEST(PatchDictionaryTest, CosinesAreOrthonormal) {
    const PatchDictionary d = cosine_dictionary({.slots = 4, .side_px = 4}, 9);
    EXPECT_EQ(d.atoms, 64);
    for (int i = 0; i < d.atoms; ++i)
        for (int j = 0; j < d.atoms; ++j)
            EXPECT_NEAR(dot(d.atom(i), d.atom(j)), i == j ? 1 : 0, 1e-6);
}

}  // namespace
}  // namespace stipple
