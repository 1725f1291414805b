#include "io/pending_output.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "io/output_file.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

TEST(PendingOutputTest, AppearsUnderItsNameOnlyWhenCommitted) {
    const TemporaryFolder folder;
    PendingOutput output(folder / "clip.mp4", false);
    EXPECT_EQ(output.partial().parent_path(), folder.path());
    EXPECT_EQ(output.partial().extension(), ".mp4");
    write_text(output.partial(), "video");
    EXPECT_FALSE(fs::exists(folder / "clip.mp4"));
    output.commit();
    EXPECT_EQ(folder.names(), Names{"clip.mp4"});
    EXPECT_EQ(read_text(folder / "clip.mp4"), "video");
}

TEST(PendingOutputTest, LeavesNothingBehindWithoutCommit) {
    const TemporaryFolder folder;
    {
        const PendingOutput file(folder / "clip.npy", false);
        write_text(file.partial(), "half");
        const PendingOutput frames(folder / "out", false, OutputKind::kFolder);
        write_text(frames.partial() / "frame_0000.exr", "half");
        EXPECT_EQ(folder.names().size(), 2U);
    }
    EXPECT_EQ(folder.names(), Names{});
}

TEST(PendingOutputTest, RefusesAnExistingOutputWithoutForce) {
    const TemporaryFolder folder;
    write_text(folder / "clip.npy", "old");
    const auto message = message_of<InputError>([&] { PendingOutput(folder / "clip.npy", false); });
    expect_parts(message, {"clip.npy: exists already", "force = true"});
    EXPECT_EQ(read_text(folder / "clip.npy"), "old");
}

TEST(PendingOutputTest, ForceReplacesAFileOnlyWhenCommitted) {
    const TemporaryFolder folder;
    write_text(folder / "clip.npy", "old");
    { const PendingOutput abandoned(folder / "clip.npy", true); }
    EXPECT_EQ(read_text(folder / "clip.npy"), "old");
    PendingOutput output(folder / "clip.npy", true);
    write_text(output.partial(), "new");
    output.commit();
    EXPECT_EQ(read_text(folder / "clip.npy"), "new");
}

TEST(PendingOutputTest, AManagedFileReplacesFilesButNoLink) {
    const TemporaryFolder folder;
    write_text(folder / "window.npy", "old");
    PendingOutput window(folder / "window.npy", true, OutputKind::kManagedFile);
    write_text(window.partial(), "new");
    window.commit();
    EXPECT_EQ(read_text(folder / "window.npy"), "new");
    refuse_links(folder.path());  // none
    for (const char* target : {"window.npy", "missing"}) {
        fs::create_symlink(target, folder / "link.npy");
        const auto expect_refused = [](const std::string& message) {
            expect_parts(message, {"link.npy: is a link", "remove it"});
        };
        expect_refused(message_of<InputError>(
            [&] { PendingOutput(folder / "link.npy", true, OutputKind::kManagedFile); }));
        expect_refused(message_of<InputError>([&] { refuse_links(folder.path()); }));
        fs::remove(folder / "link.npy");
    }
    EXPECT_EQ(read_text(folder / "window.npy"), "new");
}

TEST(PendingOutputTest, ForceReplacesAFolderOfOurFrames) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    write_text(folder / "out/frame_0000.exr", "old");
    write_text(folder / "out/frame_0001.exr", "old");
    PendingOutput output(folder / "out/", true, OutputKind::kFolder);
    write_text(output.partial() / "frame_0000.exr", "new");
    output.commit();
    EXPECT_EQ(folder.names(), Names{"out"});
    EXPECT_EQ(read_text(folder / "out/frame_0000.exr"), "new");
    EXPECT_FALSE(fs::exists(folder / "out/frame_0001.exr"));
}

TEST(PendingOutputTest, NeverReplacesAFolderThatHoldsSomethingElse) {
    for (const char* name : {"notes.txt", "frame_0000.png", "frame_1.exr", "frame_00a0.exr",
                             "frame_0000.exr.bak", ".hidden"}) {
        const TemporaryFolder folder;
        fs::create_directory(folder / "out");
        write_text(folder / "out/frame_0001.exr", "ours");
        write_text(folder / "out" / name, "theirs");
        const auto message = message_of<InputError>(
            [&] { PendingOutput(folder / "out", true, OutputKind::kFolder); });
        expect_parts(message, {"out: holds \"", name});
        EXPECT_EQ(read_text(folder / "out" / name), "theirs");
    }
}

TEST(PendingOutputTest, KeepsAFileThatComesIntoTheFolderMeanwhile) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "out");
    write_text(folder / "out/frame_0000.exr", "old");
    PendingOutput output(folder / "out", true, OutputKind::kFolder);
    write_text(output.partial() / "frame_0000.exr", "new");
    write_text(folder / "out/notes.txt", "theirs");
    expect_parts(message_of<DeviceError>([&] { output.commit(); }),
                 {"out: cannot be put in place", "what was written is in", ".partial"});
    EXPECT_EQ(read_text(folder / "out/notes.txt"), "theirs");
    EXPECT_EQ(read_text(folder / "out/frame_0000.exr"), "old");
    EXPECT_EQ(read_text(output.partial() / "frame_0000.exr"), "new");
}

TEST(PendingOutputTest, KeepsAFileThatTookTheNameMeanwhile) {
    const TemporaryFolder folder;
    PendingOutput output(folder / "clip.npy", false);
    write_text(output.partial(), "ours");
    write_text(folder / "clip.npy", "theirs");
    expect_parts(message_of<DeviceError>([&] { output.commit(); }), {"clip.npy", "meanwhile"});
    EXPECT_EQ(read_text(folder / "clip.npy"), "theirs");
}

TEST(PendingOutputTest, FileAndFolderDoNotReplaceEachOther) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "frames");
    write_text(folder / "clip", "file");
    fs::create_symlink("frames", folder / "link");
    EXPECT_THROW(PendingOutput(folder / "frames", true), InputError);
    EXPECT_THROW(PendingOutput(folder / "clip", true, OutputKind::kFolder), InputError);
    EXPECT_THROW(PendingOutput(folder / "link", true, OutputKind::kFolder), InputError);
    EXPECT_EQ(folder.names(), (Names{"clip", "frames", "link"}));
}

TEST(PendingOutputTest, TakesNoNameThatAnotherHas) {
    const TemporaryFolder folder;
    const PendingOutput one(folder / "clip.npy", true);
    const PendingOutput other(folder / "clip.npy", true);
    EXPECT_NE(one.partial(), other.partial());
    EXPECT_EQ(folder.names().size(), 2U);
}

TEST(PendingOutputTest, KeepsWhatAKilledProcessOfTheSameNumberHasLeft) {
    const TemporaryFolder folder;
    const auto left = folder / (".clip." + std::to_string(getpid()) + ".partial.npy");
    write_text(left, "theirs");
    PendingOutput output(folder / "clip.npy", false);
    write_text(output.partial(), "ours");
    output.commit();
    EXPECT_EQ(read_text(left), "theirs");
}

TEST(PendingOutputTest, DoesNotWriteThroughALinkThatSomebodyHasPutThere) {
    const TemporaryFolder folder;
    write_text(folder / "precious", "theirs");
    const PendingOutput output(folder / "clip.npy", false);
    visit_partial_outputs([](const char* path) {
        std::error_code gone;  // what another test has left
        fs::create_symlink("precious", path, gone);
    });
    expect_parts(message_of<DeviceError>([&] { return output.partial(); }),
                 {"clip.npy: cannot be created: File exists"});
    const fs::path link = folder / folder.names().front();
    EXPECT_THROW(OutputFile(link, "clip.npy"), DeviceError);
    EXPECT_EQ(read_text(folder / "precious"), "theirs");
}

TEST(PendingOutputTest, ListsWhatCouldNotBeRemovedOrPutInPlace) {
    const TemporaryFolder folder;
    static std::vector<std::string> listed;
    listed.clear();
    {
        const PendingOutput removed(folder / "a.npy", false);
        write_text(removed.partial(), "ours");
        const PendingOutput stays(folder / "b.npy", false);
        fs::remove(stays.partial());
        fs::create_directories(stays.partial() / "somebody's");
    }
    visit_partial_outputs([](const char* path) { listed.emplace_back(path); });
    ASSERT_EQ(listed.size(), 1U);
    EXPECT_EQ(fs::path(listed[0]).filename(), folder.names().front());
    EXPECT_EQ(folder.names().size(), 1U);
}

TEST(PendingOutputTest, NeverReplacesADevice) {
    const auto message = message_of<InputError>([] { PendingOutput("/dev/null", true); });
    expect_parts(message, {"/dev/null: exists already", "is not a regular file"});
}

TEST(PendingOutputTest, RefusesAMissingParentFolderAndANamelessOutput) {
    const TemporaryFolder folder;
    expect_parts(message_of<InputError>([&] { PendingOutput(folder / "no/clip.npy", false); }),
                 {"clip.npy: there is no folder", "/no\""});
    write_text(folder / "file", "");
    EXPECT_THROW(PendingOutput(folder / "file/clip.npy", false), InputError);
    for (const char* name : {"", ".", "..", "a/.."})
        expect_parts(message_of<InputError>([&] { PendingOutput(name, true); }),
                     {"give it a name"});
    expect_parts(message_of<InputError>([&] { PendingOutput("/", true); }),
                 {"\"/\": is a folder; name a file in it"});
    expect_parts(message_of<InputError>([&] { PendingOutput(folder / "no/", true); }),
                 {"/no/\": names a folder that does not exist"});
}

}  // namespace
}  // namespace stipple
