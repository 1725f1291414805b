#include "capture/recording/recording_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include "tests/capture/recording/recordings.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

struct DocumentedField {
    std::string name;
    std::string type;
    std::size_t offset = 0;
};

/// Rows "| offset | type | field | meaning |" of the table "Frame record".
std::vector<DocumentedField> documented_fields() {
    std::istringstream document(read_text(project_path("docs/recording_format.md")));
    std::string line;
    while (std::getline(document, line) && line != "## Frame record") continue;
    while (std::getline(document, line) && !line.starts_with("|---")) continue;
    std::vector<DocumentedField> fields;
    while (std::getline(document, line) && line.starts_with("|")) {
        std::istringstream words(line);
        std::string bar;
        DocumentedField field;
        words >> bar >> field.offset >> bar >> field.type >> bar >> field.name;
        if (field.offset < kFrameRecordBytes) fields.push_back(field);
    }
    return fields;
}

TEST(RecordingFormatTest, FieldsLieWhereTheDocumentSays) {
    const auto documented = documented_fields();
    const auto fields = frame_record_fields();
    ASSERT_EQ(documented.size(), fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i) {
        EXPECT_EQ(documented[i].name, fields[i].name);
        EXPECT_EQ(documented[i].offset, fields[i].offset) << fields[i].name;
        const std::string order = fields[i].type.starts_with('<') ? "<" : "";
        EXPECT_EQ(order + documented[i].type, fields[i].type) << fields[i].name;
    }
}

template <typename T>
T at(const std::vector<std::uint8_t>& bytes, std::size_t offset) {
    T value;
    std::memcpy(&value, &bytes.at(offset), sizeof(T));
    return value;
}

// Offsets and codes of docs/recording_format.md.
TEST(RecordingFormatTest, ValuesLieWhereTheDocumentSays) {
    CapturedFrame frame = test_frame(7, "BayerGR12p", 12, 4);
    FrameRecord& record = frame.record;
    record.device_ns = -5;
    record.gain = 1.5;
    record.epoch = 3;
    record.cause = GapCause::kReconnect;
    record.status = FrameStatus::kMissingPackets;
    record.layout.offset_y = 2;
    frame.holes = {{0, 4}, {8, 12}};
    const auto bytes = encode_frame_record(frame);
    ASSERT_EQ(bytes.size(), 160U + 2 * 16);
    EXPECT_EQ(at<std::uint64_t>(bytes, 0), 7U);
    EXPECT_EQ(at<std::int64_t>(bytes, 24), -5);
    EXPECT_TRUE(std::isnan(at<double>(bytes, 48)));
    EXPECT_EQ(at<double>(bytes, 56), 1.5);
    EXPECT_EQ(at<std::uint64_t>(bytes, 80), record.payload_hash);
    EXPECT_EQ(at<std::uint64_t>(bytes, 88), 18U);
    EXPECT_EQ(at<std::uint32_t>(bytes, 96), 3U);
    EXPECT_EQ(at<std::uint32_t>(bytes, 104), 2U);
    EXPECT_EQ(at<std::uint32_t>(bytes, 108), 12U);
    EXPECT_EQ(at<std::uint32_t>(bytes, 116), 2U);
    const std::vector<std::uint8_t> codes(bytes.begin() + 120, bytes.begin() + 128);
    EXPECT_EQ(codes, (std::vector<std::uint8_t>{5, 1, 1, 2, 2, 1, 12, 12}));
    EXPECT_EQ(std::string(bytes.begin() + 128, bytes.begin() + 160),
              std::string("BayerGR12p") + std::string(22, '\0'));
    EXPECT_EQ(at<std::uint64_t>(bytes, 160 + 16), 8U);
}

// Unsigned in the file; no region of a sensor begins there.
TEST(RecordingFormatTest, AnEndThatKnowsFewerCausesIsRead) {
    RecordingEnd end;
    end.lost = {0, 1, 2, 3, 4, 5};
    std::string text = encode_end(end);
    const std::string layout = ",\n  \"layout\": 0";
    const auto at = text.find(layout);
    ASSERT_NE(at, std::string::npos);
    text.erase(at, layout.size());  // as earlier versions wrote it
    EXPECT_EQ(decode_end(text, "end").lost, end.lost);
}

TEST(RecordingFormatTest, AnOffsetBeyondTheRangeOfIntIsItsMaximum) {
    CapturedFrame frame = test_frame(7);
    auto bytes = encode_frame_record(frame);
    const std::uint32_t offset = 1U << 31U;
    std::memcpy(&bytes.at(100), &offset, sizeof offset);
    EXPECT_EQ(decode_frame_record(bytes, frame.payload.size(), frame), "");
    EXPECT_EQ(frame.record.layout.offset_x, std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace stipple
