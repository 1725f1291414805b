#include "core/philox.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "sensor_model/sample_words.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

// The vectors philox4x32 10 of examples/kat_vectors in Random123 (D. E. Shaw Research).
TEST(PhiloxTest, GivesTheKnownAnswersOfRandom123) {
    EXPECT_EQ(philox4x32({0, 0, 0, 0}, 0),
              (PhiloxCounter{0x6627E8D5, 0xE169C58D, 0xBC57AC4C, 0x9B00DBD8}));
    EXPECT_EQ(philox4x32({0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF, 0xFFFFFFFF}, 0xFFFFFFFFFFFFFFFF),
              (PhiloxCounter{0x408F276D, 0x41C83B0E, 0xA20BC7C6, 0x6D5451FD}));
    // Digits of pi; the key's low word is its first.
    EXPECT_EQ(philox4x32({0x243F6A88, 0x85A308D3, 0x13198A2E, 0x03707344}, 0x299F31D0A4093822),
              (PhiloxCounter{0xD16CFE09, 0x94FDCCEB, 0x5001E420, 0x24126EA1}));
}

// docs/sensor_model.md, "Random numbers": changing this changes every recorded bit.
TEST(PhiloxTest, AddressesADrawByPixelSlotPurposeAndPlaneAndLayout) {
    EXPECT_EQ(random_address(7, 9, RandomPurpose::kSample, 2), (PhiloxCounter{7, 9, 0x200, 1}));
    EXPECT_EQ(random_address(7, 9, RandomPurpose::kFixedPattern, 0), (PhiloxCounter{7, 9, 2, 1}));
}

TEST(SampleWordsTest, AreWordsZeroAndOneOfTheBlockOnEverySimdTarget) {
    std::vector<std::uint32_t> pixels(1003);               // not a multiple of any vector length
    std::iota(pixels.begin(), pixels.end(), 0xFFFFFF00U);  // wraps round to small numbers
    const SampleAddress address{.seed = 0xFEDCBA9876543210, .slot = 0x89ABCDEF, .plane = 2};
    for_each_simd_target([&](const std::string& target) {
        std::vector<std::uint32_t> shot(pixels.size()), read(pixels.size());
        sample_words(pixels, address, shot, read);
        for (std::size_t i = 0; i < pixels.size(); ++i) {
            const PhiloxCounter block = philox4x32(
                random_address(pixels[i], address.slot, RandomPurpose::kSample, address.plane),
                address.seed);
            ASSERT_EQ(shot[i], block[0]) << target << " pixel " << pixels[i];
            ASSERT_EQ(read[i], block[1]) << target << " pixel " << pixels[i];
        }
    });
}

}  // namespace
}  // namespace stipple
