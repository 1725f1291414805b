// The files in tests/golden/stream say what version 2 is, for other programs too. After an intended
// change of the format: STIPPLE_UPDATE_GOLDEN=1 build/release/stream_test --gtest_filter='Golden*'
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "stream/schedule_switch.h"
#include "tests/stream/golden_cases.h"
#include "tests/stream/stream_bytes.h"
#include "tests/support/golden_file.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

using Json = nlohmann::ordered_json;

const std::filesystem::path kFolder = project_path("tests/golden/stream");
/// Streams with weights, and without noise.
const std::filesystem::path kFolder3 = project_path("tests/golden/stream_version_3");
/// Streams whose schedule changes.
const std::filesystem::path kFolder4 = project_path("tests/golden/stream_version_4");
/// As this library wrote and read them when it knew version 1 only.
const std::filesystem::path kFolder1 = project_path("tests/golden/stream_version_1");

Json to_json(const ExposureSchedule& schedule) {
    Json pixels = Json::array();
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            Json exposures = Json::array();
            for (const Exposure& exposure : schedule.exposures(row, col))
                exposures.push_back({exposure.first_slot, exposure.open_slots});
            pixels.push_back(exposures);
        }
    return {{"tile_rows", schedule.tile_rows()},
            {"tile_cols", schedule.tile_cols()},
            {"period_slots", schedule.period_slots()},
            {"exposures", pixels}};
}

Json to_json(const StreamHeader& header) {
    const Calibration& c = header.calibration;
    Json json{{"rows", header.shape.rows},
              {"cols", header.shape.cols},
              {"planes", header.shape.planes},
              {"slot_us", header.slot_us},
              {"bit_depth", c.bit_depth},
              {"rounding", c.rounding == Rounding::kNearest ? "nearest" : "floor"},
              {"black_level_dn", c.black_level_dn},
              {"gain_e_per_dn", c.gain_e_per_dn},
              {"read_noise_e", c.read_noise_e},
              {"full_well_e", c.full_well_e},
              {"electrons_per_unit", c.electrons_per_unit},
              {"schedule_name", header.schedule_name},
              {"provenance", header.provenance},
              {"schedule", to_json(header.schedule)}};
    if (c.dark_e_per_slot != 0 || c.tile.rows != 0) {
        json["dark_e_per_slot"] = c.dark_e_per_slot;
        json["calibration_tile"] = {c.tile.rows, c.tile.cols};
        for (const CalibrationPixel& pixel : c.tile.pixels)
            json["calibration_tile"].push_back({pixel.responsivity, pixel.conversion_gain});
    }
    if (header.cfa != ColourFilter::kNone) json["cfa"] = name_of(header.cfa);
    if (header.schedule.weighted())
        json["weights"] =
            std::vector<double>(header.schedule.weights().begin(), header.schedule.weights().end());
    if (c.noise_free) json["noise_free"] = true;
    return json;
}

Json to_json(const ScheduleSwitch& part) {
    const ReadoutValues& v = part.values;
    return {{"number", part.number},
            {"slot", part.slot},
            {"rounding", v.rounding == Rounding::kNearest ? "nearest" : "floor"},
            {"black_level_dn", v.black_level_dn},
            {"gain_e_per_dn", v.gain_e_per_dn},
            {"read_noise_e", v.read_noise_e},
            {"full_well_e", v.full_well_e},
            {"electrons_per_unit", v.electrons_per_unit},
            {"schedule_name", part.name},
            {"schedule", to_json(part.schedule)}};
}

/// Of each sample of a packet.
Json exposures_json(const StreamHeader& header, const SamplePacket& packet) {
    Json json = Json::array();
    if (packet.dn.empty()) return json;
    const auto parts = schedule_parts(header);
    const SchedulePart part = schedule_at(header, packet.slot);
    const std::int64_t slot = readout_slot(part, packet.slot);
    for (int row = packet.first_row; row < packet.first_row + packet.rows; ++row)
        for_each_readout(*part.schedule, slot, row, header.shape.cols, [&](int col, int) {
            const auto read = read_exposure(parts, {packet.slot, row, col});
            for (int plane = 0; plane < header.shape.planes; ++plane)
                json.push_back(read ? Json{read->first_slot, read->open_slots} : Json());
        });
    return json;
}

Json to_json(const SamplePacket& packet) {
    return {{"slot", packet.slot},
            {"first_row", packet.first_row},
            {"rows", packet.rows},
            {"flags", packet.flags},
            {"dn", packet.dn}};
}

Json to_json(const StreamDamage& damage) {
    return {{"offset", damage.offset}, {"bytes", damage.bytes}, {"cause", damage.cause}};
}

/// A message without the name of the file; null if there is none.
template <typename Action>
Json refusal(const MemoryFile& file, Action&& action) {
    try {
        action();
    } catch (const InputError& error) {
        return std::string(error.what()).substr(file.path().string().size() + 2);
    }
    return nullptr;
}

/// All that a file says to a tolerant reader, and what a strict one has against it.
Json description(const std::string& bytes) {
    const MemoryFile file(bytes);
    Json text;
    text["strict_error"] = refusal(file, [&] {
        StreamReader reader(file.path(), ReadPolicy::kStrict);
        reader.follow_switches();
        read_packets(reader);
    });
    text["error"] = refusal(file, [&] {
        StreamReader reader(file.path());
        reader.follow_switches();
        text["header"] = to_json(reader.header());
        text["packets"] = Json::array();
        for (const SamplePacket& packet : read_packets(reader)) {
            text["packets"].push_back(to_json(packet));
            if (reader.header().may_switch)
                text["packets"].back()["exposures"] = exposures_json(reader.header(), packet);
        }
        if (reader.header().may_switch) text["switches"] = Json::array();
        for (const ScheduleSwitch& part : reader.header().switches)
            text["switches"].push_back(to_json(part));
        const StreamReport& report = reader.report();
        text["slots"] = report.slots;
        text["missing_slots"] = report.missing_slots;
        text["tail_bytes"] = report.tail_bytes;
        text["damage"] = Json::array();
        for (const StreamDamage& damage : report.damage) text["damage"].push_back(to_json(damage));
    });
    return text;
}

struct GoldenFile {
    std::filesystem::path path;  ///< without extension
    std::string bytes;
};

std::vector<GoldenFile> golden_files() {
    std::vector<GoldenFile> files;
    for (const auto& [name, bytes] : golden_cases()) files.push_back({kFolder / name, bytes});
    for (const auto& [name, bytes] : golden_cases_3()) files.push_back({kFolder3 / name, bytes});
    for (const auto& [name, bytes] : golden_cases_4()) files.push_back({kFolder4 / name, bytes});
    return files;
}

TEST(GoldenTest, EachFileIsWrittenAsEver) {
    for (const auto& [path, bytes] : golden_files())
        expect_golden_bytes(path.string() + ".stipple", bytes);
}

TEST(GoldenTest, EachFileReadsAsItsDescriptionSays) {
    for (const auto& [path, bytes] : golden_files())
        expect_golden_text(path.string() + ".json",
                           golden_text(description(read_text(path.string() + ".stipple"))));
}

TEST(GoldenTest, FilesOfVersion1AreReadAsEver) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder1)) {
        if (entry.path().extension() != ".stipple") continue;
        auto json = entry.path();
        json.replace_extension(".json");
        EXPECT_EQ(read_text(json), golden_text(description(read_text(entry.path()))))
            << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 24);
}

TEST(GoldenTest, AFileOfVersion1TellsItsSlotsAtOnce) {
    EXPECT_EQ(StreamReader(kFolder1 / "bands_of_rows.stipple").slots(), 3);
    EXPECT_EQ(StreamReader(kFolder1 / "interrupted.stipple").slots(), std::nullopt);
}

TEST(GoldenTest, NoFileIsLeftOver) {
    std::size_t files = 0;
    for (const auto& folder : {kFolder, kFolder3, kFolder4})
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().filename() != "README.md") ++files;
    EXPECT_EQ(files, 2 * golden_files().size());
}

}  // namespace
}  // namespace stipple
