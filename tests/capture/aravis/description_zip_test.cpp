#include "capture/aravis/genicam_description.h"

#include <gtest/gtest.h>

#include "tests/capture/aravis/zip_of.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes kXml = bytes_of("<RegisterDescription>" + std::string(200, ' ') + "</R>");

TEST(DescriptionZipTest, AFileIsReadWhetherItIsPackedOrNot) {
    EXPECT_EQ(unzipped_description(zip_of(kXml, true), 1000), kXml);
    EXPECT_EQ(unzipped_description(zip_of(kXml, false), 1000), kXml);
}

TEST(DescriptionZipTest, BytesBeforeAndBehindTheZipFileDoNotMatter) {
    Bytes zip = zip_of(kXml, true);
    zip.insert(zip.begin(), 7, 0);
    zip.insert(zip.end(), 9, 0);
    EXPECT_EQ(unzipped_description(zip, 1000), kXml);
}

TEST(DescriptionZipTest, ALargeFileIsRefusedBeforeMemoryIsTaken) {
    EXPECT_FALSE(unzipped_description(zip_of(kXml, true), kXml.size() - 1));
    Bytes zip = zip_of(kXml, true);
    zip[zip.size() - 22 - 51 + 24 + 3] = 0xFF;  // the unpacked size in the directory
    EXPECT_FALSE(unzipped_description(zip, 1U << 24U));
}

TEST(DescriptionZipTest, WhereverItIsCutOrChangedNothingIsReadOutside) {
    const Bytes whole = zip_of(kXml, true);
    for (std::size_t bytes = 0; bytes < whole.size() - 4; ++bytes)
        EXPECT_FALSE(unzipped_description(std::span(whole).first(bytes), 1000)) << bytes;
    for (std::size_t at = 0; at < whole.size(); ++at)
        for (const int change : {0x01, 0x80, 0xFF}) {
            Bytes changed = whole;
            changed[at] ^= static_cast<std::uint8_t>(change);
            static_cast<void>(unzipped_description(changed, 1000));  // the sanitizers look
        }
}

TEST(DescriptionZipTest, NothingPackedAtTheEndOfTheBytesIsNotRead) {
    Bytes zip = zip_of(kXml, true);
    const std::size_t directory = zip.size() - 22 - 51;
    zip[directory + 20] = zip[directory + 21] = 0;                   // packed bytes
    zip[28] = static_cast<std::uint8_t>(zip.size() - 30 - zip[26]);  // bytes before them
    static_cast<void>(unzipped_description(zip, 1000));              // the sanitizers look
}

}  // namespace
}  // namespace stipple
