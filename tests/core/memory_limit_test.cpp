#include "core/memory_limit.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20U;

void write(const std::filesystem::path& file, std::string_view text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

TEST(MemoryLimitTest, SizesArePowersOf1024) {
    EXPECT_EQ(parse_memory("1M"), kMiB);
    EXPECT_EQ(parse_memory("1024K"), kMiB);
    EXPECT_EQ(parse_memory("2G"), 2048 * kMiB);
    EXPECT_EQ(parse_memory("1.5G"), 1536 * kMiB);
    EXPECT_EQ(parse_memory("1T"), 1024 * 1024 * kMiB);
    for (const char* text :
         {"", "M", "1", "1023K", "-1G", "1Q", "1 G", "1GB", "nanG", "infG", "9999999T"})
        EXPECT_FALSE(parse_memory(text)) << text;
}

TEST(MemoryLimitTest, TheLowestLimitOfTheControlGroupsIsTheMemory) {
    const TemporaryFolder folder;
    const auto proc = folder / "proc", groups = folder / "groups";
    const auto memory = [&] { return machine_memory(proc, groups); };
    const std::uint64_t machine = memory();
    EXPECT_GT(machine, 64 * kMiB);
    write(proc / "cgroup", "0::/user/run\n");
    write(groups / "user/run/memory.max", "max\n");
    EXPECT_EQ(memory(), machine);
    write(groups / "user/run/memory.max", "50331648\n");
    EXPECT_EQ(memory(), 48 * kMiB);
    write(groups / "user/memory.max", "33554432\n");
    EXPECT_EQ(memory(), 32 * kMiB);
    write(proc / "cgroup", "3:cpu:/user/run\n4:memory:/job\n");
    EXPECT_EQ(memory(), machine);
    write(groups / "memory/memory.limit_in_bytes", "9223372036854771712\n");
    write(groups / "memory/job/memory.limit_in_bytes", "16777216\n");
    EXPECT_EQ(memory(), 16 * kMiB);
}

TEST(MemoryLimitTest, SmallInputsHaveALimitOfTheirOwnUnlessOneIsTold) {
    EXPECT_EQ(max_memory(), machine_memory() / 4);
    EXPECT_EQ(max_memory(kSmallInput), max_memory());
    EXPECT_LE(max_memory(kSmallInput - 1), 256 * kMiB);
    {
        const MemoryLimit limit(300 * kMiB);
        EXPECT_EQ(max_memory(1), 300 * kMiB);
        EXPECT_NO_THROW(check_memory(300 * kMiB, "a", "b", 1));
        EXPECT_THROW(check_memory(300 * kMiB + 1, "a", "b"), InputError);
    }
    EXPECT_EQ(max_memory(), machine_memory() / 4);
}

TEST(MemoryLimitTest, AllMessagesNameWhatIsNeededAndAnOptionThatIsEnough) {
    const MemoryLimit limit(kMiB);
    for (std::uint64_t bytes = 2 * kMiB; bytes < kMiB << 22U; bytes += bytes / 3 + 1) try {
            check_memory(bytes, "clip", "its frames");
            FAIL();
        } catch (const InputError& error) {
            const std::string text = error.what();
            EXPECT_TRUE(text.starts_with("clip: needs ")) << text;
            const auto at = text.find("max_memory = ", text.find(';')) + 13;
            const auto enough = parse_memory(text.substr(at, text.find(' ', at) - at));
            ASSERT_TRUE(enough) << text;
            EXPECT_GE(*enough, bytes);
        }
}

}  // namespace
}  // namespace stipple
