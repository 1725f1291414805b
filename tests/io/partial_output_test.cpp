#include "io/partial_output.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>

#include "io/pending_output.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

constexpr int kNobody = 999'999'999;  // beyond the largest process number of Linux, 2^22

TEST(PartialOutputTest, ItsNameTellsWhatItWasGoingToBe) {
    for (const char* name : {"clip.stipple", "a.b.strec", "frames", "x.1.npy", "1"}) {
        const auto found = partial_output(partial_path(fs::path("folder") / name, 4711, 0xBEEF));
        ASSERT_TRUE(found) << name;
        EXPECT_EQ(found->final_path, fs::path("folder") / name);
        EXPECT_EQ(found->process, 4711);
    }
}

TEST(PartialOutputTest, NamesOfVersion01HaveNoRandomPart) {
    const auto found = partial_output("folder/.clip.4711.partial.npy");
    ASSERT_TRUE(found);
    EXPECT_EQ(found->final_path, "folder/clip.npy");
    EXPECT_EQ(found->process, 4711);
}

TEST(PartialOutputTest, OtherNamesAreNone) {
    for (const char* name :
         {"", ".", "clip.stipple", ".partial", ".clip.partial.npy", ".clip.12x.partial.npy",
          "clip.12.partial.npy", "..12.partial.npy", ".clip.-1.partial", ".clip.0.partial",
          ".clip.12.partially.npy", ".clip.12-.partial.npy", ".clip.12-0g.partial.npy",
          ".clip.12-a-b.partial.npy", ".clip.99999999999.partial.npy"})
        EXPECT_FALSE(partial_output(name)) << name;
}

TEST(PartialOutputTest, ThoseOfAFolderAreListedAndTellWhoIsAtWork) {
    const TemporaryFolder folder;
    const PendingOutput mine(folder / "mine.npy", false);
    write_text(mine.partial(), "half");
    write_text(partial_path(folder / "left.npy", kNobody, 1), "half");
    write_text(folder / "whole.npy", "whole");
    const auto found = partial_outputs(folder.path());
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].final_path, folder / "left.npy");
    EXPECT_FALSE(found[0].running());
    EXPECT_EQ(found[1].process, getpid());
    EXPECT_TRUE(found[1].running());
    EXPECT_EQ(partial_of(folder / "left.npy"), found[0].path);
    EXPECT_FALSE(partial_of(folder / "whole.npy"));
    EXPECT_TRUE(partial_outputs(folder / "missing").empty());
}

TEST(PartialOutputTest, AProcessThatIsYoungerThanTheFileOnlyHasItsNumber) {
    const TemporaryFolder folder;
    const fs::path file = partial_path(folder / "old.npy", getpid(), 1);
    write_text(file, "half");
    EXPECT_TRUE(partial_output(file)->running());
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(24 * 365));
    EXPECT_FALSE(partial_output(file)->running());
}

TEST(PartialOutputTest, ANameThatIsTakenIsNotReplaced) {
    const TemporaryFolder folder;
    write_text(folder / "a", "a");
    write_text(folder / "b", "b");
    EXPECT_FALSE(rename_to_free_name(folder / "a", folder / "b"));
    EXPECT_EQ(read_text(folder / "b"), "b");
    EXPECT_TRUE(rename_to_free_name(folder / "a", folder / "c"));
    EXPECT_EQ(folder.names(), (Names{"b", "c"}));
    EXPECT_THROW(static_cast<void>(rename_to_free_name(folder / "a", folder / "d")),
                 fs::filesystem_error);
}

}  // namespace
}  // namespace stipple
