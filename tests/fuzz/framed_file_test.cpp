#include "tests/fuzz/framed_file.h"

#include <gtest/gtest.h>

#include "capture/recording/recording_reader.h"
#include "core/input_file.h"
#include "io/png_file.h"
#include "stream/stream_reader.h"
#include "tests/fuzz/png_pieces.h"
#include "tests/fuzz/recording_pieces.h"
#include "tests/fuzz/stream_pieces.h"
#include "tests/support/memory_file.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

Bytes seed(const std::string& name) {
    return read_file(project_path("tests/fuzz/corpus") / name);
}

/// With a byte of each body changed.
Bytes mended(const FramedFormat& format, const Bytes& bytes, unsigned number) {
    Dice dice(number);
    auto pieces = format.cut(bytes);
    for (Piece& piece : pieces)
        if (!piece.body.empty()) piece.body.front() ^= 1U;
    format.mend(pieces, dice);
    return join(pieces);
}

TEST(FramedFileTest, PiecesAddUpToTheFile) {
    for (const auto& [folder, format] :
         {std::pair{"stream", kStreamFormat}, {"recording", kRecordingFormat}, {"png", kPngFormat}})
        for (const auto& entry :
             fs::directory_iterator(project_path("tests/fuzz/corpus") / folder)) {
            const Bytes bytes = read_file(entry.path());
            const auto pieces = format.cut(bytes);
            EXPECT_EQ(join(pieces), pieces.empty() ? Bytes() : bytes) << entry.path();
        }
}

TEST(FramedFileTest, MendedStreamsAreWholeAtLeastNowAndThen) {
    int whole = 0;
    for (unsigned number = 1; number <= 16; ++number) {
        const MemoryFile file(mended(kStreamFormat, seed("stream/example"), number));
        StreamReader reader(file.path());
        SamplePacket packet;
        while (reader.next(packet)) continue;
        whole += reader.report().complete && reader.report().damage.empty();
    }
    EXPECT_GT(whole, 0);
}

TEST(FramedFileTest, MendedRecordingsKeepTheirFrames) {
    const MemoryFile file(mended(kRecordingFormat, seed("recording/mono8"), 1));
    const MemoryFile before(seed("recording/mono8"));
    const auto frames = [](const std::string& path) {
        RecordingReader reader(path);
        CapturedFrame frame;
        while (reader.next(frame)) continue;
        return reader.report().frames;
    };
    EXPECT_GT(frames(before.path()), 0U);
    EXPECT_EQ(frames(file.path()), frames(before.path()));
}

TEST(FramedFileTest, MendedPngChunksHaveGoodCrcs) {
    Bytes bytes = seed("png/grey8");
    Dice dice(1);
    auto pieces = kPngFormat.cut(bytes);
    ASSERT_GT(pieces.size(), 2U);
    pieces[1].body[7] = 2;  // height
    kPngFormat.mend(pieces, dice);
    EXPECT_EQ(decode_png(join(pieces), "fuzz").pixels.rows, 2);
}

}  // namespace
}  // namespace stipple
