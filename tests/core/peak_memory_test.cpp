#include "core/peak_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace stipple {
namespace {

constexpr std::size_t kBytes = std::size_t{64} << 20U;

/// Takes the memory, and gives it back.
void fill_memory() {
    std::vector<unsigned char> bytes(kBytes);
    std::ranges::fill(bytes, static_cast<unsigned char>(1));
    ASSERT_EQ(*std::ranges::max_element(bytes), 1);
}

TEST(PeakMemoryTest, CountsWhatIsTakenMeanwhileAndNotBefore) {
    fill_memory();
    const PeakMemory idle;
    if (!idle.bytes()) GTEST_SKIP() << "/proc/self/clear_refs cannot be written here";
    EXPECT_LT(*idle.bytes(), kBytes / 4);
    const PeakMemory working;
    fill_memory();
    fill_memory();
    // Pages of the heap itself come and go: an eighth for them.
    EXPECT_GE(*working.bytes(), kBytes * 7 / 8);
    EXPECT_LT(*working.bytes(), kBytes * 9 / 8);
}

}  // namespace
}  // namespace stipple
