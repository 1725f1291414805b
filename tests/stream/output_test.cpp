#include <gtest/gtest.h>

#include "core/error.h"
#include "io/pending_output.h"
#include "tests/stream/stream_files.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

void record(const std::filesystem::path& file, const StreamHeader& header) {
    PendingOutput output(file, false);
    StreamWriter writer(output.partial(), header, file.string());
    for (const SamplePacket& packet : random_packets(header, 10, 2)) writer.write(packet);
    writer.finish();
    output.commit();
}

TEST(OutputTest, ARecordingAppearsUnderItsNameWhenItIsComplete) {
    const TemporaryFolder folder;
    record(folder / "clip.stipple", varied_header());
    EXPECT_EQ(folder.names(), std::vector<std::string>{"clip.stipple"});
    EXPECT_EQ(StreamReader(folder / "clip.stipple").slots(), 10);
}

TEST(OutputTest, AFullDiskIsReportedUnderTheFinalNameAndLeavesNothing) {
    const TemporaryFolder folder;
    record(folder / "whole.stipple", varied_header());
    const auto bytes = std::filesystem::file_size(folder / "whole.stipple");
    for (rlim_t limit = 0; limit < bytes; limit += 50) {
        const FileSizeLimit full_disk(limit);
        const auto message =
            message_of<DeviceError>([&] { record(folder / "clip.stipple", varied_header()); });
        expect_parts(message, {(folder / "clip.stipple").string() + ": cannot be written: "});
        EXPECT_EQ(message.find("partial"), std::string::npos) << message;
        EXPECT_EQ(folder.names(), std::vector<std::string>{"whole.stipple"}) << limit;
    }
}

TEST(OutputTest, AFullDeviceIsReported) {
    expect_parts(message_of<DeviceError>([] { StreamWriter("/dev/full", varied_header()); }),
                 {"/dev/full: cannot be written: No space left on device"});
}

TEST(OutputTest, ALinkIsNotWrittenThrough) {
    const TemporaryFolder folder;
    write_text(folder / "precious", "theirs");
    std::filesystem::create_symlink("precious", folder / "clip.stipple");
    EXPECT_THROW(StreamWriter(folder / "clip.stipple", varied_header()), DeviceError);
    EXPECT_EQ(read_text(folder / "precious"), "theirs");
}

TEST(OutputTest, AFolderThatIsMissingIsReported) {
    const TemporaryFolder folder;
    expect_parts(message_of<DeviceError>(
                     [&] { StreamWriter(folder / "no" / "clip.stipple", varied_header()); }),
                 {"clip.stipple: cannot be written: No such file"});
}

TEST(OutputTest, ABadHeaderIsRefusedBeforeTheFileIsCreated) {
    const TemporaryFolder folder;
    StreamHeader header = varied_header();
    header.calibration.bit_depth = 17;
    expect_parts(message_of<InputError>([&] { StreamWriter(folder / "clip.stipple", header); }),
                 {"clip.stipple", "bit depth 17 is outside 1..16"});
    EXPECT_TRUE(folder.names().empty());
}

TEST(OutputTest, AMissingFileOrAFolderCannotBeRead) {
    const TemporaryFolder folder;
    expect_parts(message_of<InputError>([&] { StreamReader(folder / "no.stipple"); }),
                 {"no.stipple: cannot be read: No such file"});
    expect_parts(message_of<InputError>([&] { StreamReader(folder.path()); }),
                 {folder.path().string() + ": cannot be read: Is a directory"});
}

}  // namespace
}  // namespace stipple
