#include "core/peak_memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstddef>
#include <cstring>

namespace stipple {
namespace {

constexpr std::size_t kBytes = std::size_t{64} << 20U;

/// Takes the memory, and gives it back: past the heap, which under a sanitizer keeps what is freed.
void fill_memory() {
    void* bytes = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(bytes, MAP_FAILED);
    std::memset(bytes, 1, kBytes);
    ASSERT_EQ(munmap(bytes, kBytes), 0);
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
