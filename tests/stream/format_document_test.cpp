#include <gtest/gtest.h>

#include <cctype>
#include <sstream>

#include "stream/slot_index.h"
#include "tests/stream/golden_cases.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

/// Lines between "```hex" and "```" in docs/stream_format.md.
std::vector<std::string> hex_lines() {
    std::istringstream document(read_text(project_path("docs/stream_format.md")));
    std::vector<std::string> lines;
    std::string line;
    while (std::getline(document, line) && line != "```hex") continue;
    while (std::getline(document, line) && line != "```") lines.push_back(line);
    return lines;
}

bool is_byte(const std::string& word) {
    return word.size() == 2 && std::isxdigit(word[0]) != 0 && std::isxdigit(word[1]) != 0;
}

/// Reads lines "offset: byte byte ... | meaning"; an offset must be the number of bytes before.
std::string example_bytes() {
    std::string bytes;
    for (const std::string& line : hex_lines()) {
        std::istringstream words(line.substr(0, line.find('|')));
        std::string word;
        words >> word;
        EXPECT_EQ(std::stoul(word, nullptr, 16), bytes.size()) << line;
        while (words >> word) {
            EXPECT_TRUE(is_byte(word)) << line;
            bytes += static_cast<char>(std::stoi(word, nullptr, 16));
        }
    }
    return bytes;
}

TEST(FormatDocumentTest, TheExampleIsWhatTheWriterWrites) {
    EXPECT_TRUE(example_bytes() == example_stream());
}

// The numbers are those in the text above the example.
TEST(FormatDocumentTest, TheExampleReadsAsItsTextSays) {
    const std::string bytes = example_bytes();
    ASSERT_FALSE(bytes.empty());
    const auto [packets, report] = read_bytes(bytes, ReadPolicy::kStrict);
    ASSERT_EQ(packets.size(), 2U);
    EXPECT_EQ(packets[0].dn, (std::vector<std::uint16_t>{1023, 1}));
    EXPECT_EQ(packets[1].dn, (std::vector<std::uint16_t>{512, 3, 4, 0}));
    EXPECT_EQ(report.slots, 2);
}

// "0.063 % of ...": 36 bytes per packet and 16 in the index, against 8 bits a sample.
TEST(FormatDocumentTest, TheOverheadOfAVgaSlotIsAsTheTextSays) {
    const StreamHeader header = random_header({480, 640, 1}, 1);
    const std::size_t samples = count_due(header.schedule, 100, 0, 480, 640);
    // 4 exposures in 15 slots: 81 920 on average; each pixel is an independent Bernoulli draw, so
    // 4 standard deviations are 4 sqrt(307200 p (1 - p)) with p = 4/15, that is 980.
    EXPECT_NEAR(static_cast<double>(samples), 81920, 980);
    const double overhead = (kPacketHeaderBytes + kIndexEntryBytes) / static_cast<double>(samples);
    EXPECT_NEAR(overhead, 0.00063, 0.00002);
    EXPECT_LT(overhead, 0.005);
}

}  // namespace
}  // namespace stipple
