// The files in tests/golden/recording say what the format is, for other programs too. After an
// intended change: STIPPLE_UPDATE_GOLDEN=1 build/release/capture_test --gtest_filter='GoldenRec*'
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "capture/frame_light.h"
#include "core/error.h"
#include "tests/capture/recording/golden_recordings.h"
#include "tests/capture/recording/recordings.h"
#include "tests/support/golden_file.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

const std::filesystem::path kFolder = project_path("tests/golden/recording");

Json or_null(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

Json samples_of(const CapturedFrame& frame) {
    const FrameLayout& layout = frame.record.layout;
    std::vector<std::uint16_t> samples;
    unpack_frame(layout, frame.payload, samples);
    const auto height = static_cast<std::ptrdiff_t>(layout.height);
    const auto row = static_cast<std::ptrdiff_t>(samples.size()) / height;
    Json rows = Json::array();
    for (auto at = samples.begin(); at != samples.end(); at += row)
        rows.push_back(std::vector<std::uint16_t>(at, at + row));
    return rows;
}

Json to_json(const CapturedFrame& frame) {
    const FrameRecord& record = frame.record;
    const FrameLayout& layout = record.layout;
    const PixelFormat& format = *layout.format;
    return {{"id", record.id},
            {"wire_id", record.wire_id},
            {"lost_before", record.lost_before},
            {"device_ns", record.device_ns},
            {"host_monotonic_ns", record.host_monotonic_ns},
            {"host_realtime_ns", record.host_realtime_ns},
            {"exposure_us", or_null(record.exposure_us)},
            {"gain", or_null(record.gain)},
            {"black_level_dn", or_null(record.black_level_dn)},
            {"bytes_received", record.bytes_received},
            {"stride_bytes", layout.stride_bytes},
            {"epoch", record.epoch},
            {"offset_x", layout.offset_x},
            {"offset_y", layout.offset_y},
            {"width", layout.width},
            {"height", layout.height},
            {"holes", frame.holes},
            {"cause", static_cast<int>(record.cause)},
            {"status", static_cast<int>(record.status)},
            {"stamp_source", static_cast<int>(record.stamp_source)},
            {"packing", static_cast<int>(format.packing)},
            {"filter", static_cast<int>(format.filter)},
            {"planes", format.planes},
            {"bits_per_pixel", format.bits_per_pixel},
            {"significant_bits", format.significant_bits},
            {"format", std::string(format.name)},
            {"samples", samples_of(frame)}};
}

/// All that a file says to a reader.
Json description(const std::filesystem::path& file) {
    Json text{{"error", nullptr}};
    try {
        RecordingReader reader(file);
        const auto frames = read_frames(reader);
        const RecordingReport& report = reader.report();
        const bool session = !reader.session().host.empty();
        text["session"] = session ? Json::parse(encode_session(reader.session())) : Json();
        text["frames"] = Json::array();
        for (const CapturedFrame& frame : frames) text["frames"].push_back(to_json(frame));
        text["end"] = reader.end() ? Json::parse(encode_end(*reader.end())) : Json();
        text["missing_blocks"] = report.missing_blocks;
        text["tail_bytes"] = report.tail_bytes;
        text["damage"] = Json::array();
        for (const RecordingDamage& damage : report.damage)
            text["damage"].push_back(
                {{"offset", damage.offset}, {"bytes", damage.bytes}, {"cause", damage.cause}});
    } catch (const InputError& error) {
        text["error"] = "byte 0: " + std::string(error.what()).substr(file.string().size() + 2);
    }
    return text;
}

TEST(GoldenRecordingTest, EachFileIsWrittenAsEver) {
    for (const auto& [name, bytes] : golden_recordings())
        expect_golden_bytes(kFolder / (name + ".strec"), bytes);
}

TEST(GoldenRecordingTest, EachFileReadsAsItsDescriptionSays) {
    for (const auto& [name, bytes] : golden_recordings())
        expect_golden_text(kFolder / (name + ".json"),
                           golden_text(description(kFolder / (name + ".strec"))));
}

TEST(GoldenRecordingTest, NoFileIsLeftOver) {
    const auto files = std::filesystem::directory_iterator(kFolder);
    EXPECT_EQ(static_cast<std::size_t>(std::distance(begin(files), end(files))),
              2 * golden_recordings().size());
}

}  // namespace
}  // namespace stipple
