#include "stream/stream_reader.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

class StreamIdentityTest : public testing::Test {
  protected:
    std::optional<std::string> identity(const std::string& bytes) {
        write_text(folder_ / "a.stipple", bytes);
        return stream_identity(folder_ / "a.stipple");
    }
    static std::string stream(const std::string& provenance, int slots = 6) {
        StreamHeader header = varied_header({7, 4, 1}, 10);
        header.provenance = provenance;
        return bytes_of(header, random_packets(header, slots, 3)).bytes;
    }

    const TemporaryFolder folder_;
};

TEST_F(StreamIdentityTest, DiffersByHeaderAndByPackets) {
    const auto a = identity(stream("a"));
    ASSERT_TRUE(a);
    EXPECT_EQ(identity(stream("a")), a);
    EXPECT_NE(identity(stream("b")), a);
    EXPECT_NE(identity(stream("a", 5)), a);
}

TEST_F(StreamIdentityTest, NeedsTheEndOfTheStream) {
    const std::string whole = stream("a");
    for (const std::size_t lacking : {1U, 20U, 30U})
        EXPECT_EQ(identity(whole.substr(0, whole.size() - lacking)), std::nullopt);
    EXPECT_EQ(identity(whole + "x"), std::nullopt);
    EXPECT_THROW(identity("no stream, but long enough"), InputError);
}

}  // namespace
}  // namespace stipple
