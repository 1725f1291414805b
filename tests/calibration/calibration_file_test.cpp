#include "calibration/calibration_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

#include "core/error.h"
#include "stream/crc32c.h"
#include "stream/little_endian.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

ChipCalibration example() {
    ChipCalibration c{.shape = {.rows = 2, .cols = 3, .planes = 1},
                      .cfa = ColourFilter::kGrbg,
                      .bit_depth = 12,
                      .tile_rows = 2,
                      .tile_cols = 1,
                      .chip = {.name = "t6", .device_id = 7},
                      .flats = 100,
                      .darks = 200,
                      .sites = {}};
    for (int i = 0; i < 6; ++i) {
        const auto x = static_cast<float>(i);
        c.sites.push_back({.gain = 1 + x / 16,
                           .gain_variance = x / 1024,
                           .offset_dn = 64 - x,
                           .offset_variance_dn2 = x / 8,
                           .dark_dn_per_s = x - 2,
                           .dark_variance = x * 3,
                           .readout_noise_dn2 = x * 4,
                           .defect = i == 4});
    }
    return c;
}

/// The same chip with 2 bits and a response table.
ChipCalibration bent_example() {
    ChipCalibration c = example();
    c.bit_depth = 2;
    c.response = {.linear_dn = {-1, 1, 2.5F, 5}, .variance_dn2 = {0, 0.25F, 0.5F, 1}};
    return c;
}

std::string message(const std::vector<std::uint8_t>& bytes) {
    return message_of<InputError>([&] { return decode_chip_calibration(bytes, "chip.stcal"); });
}

/// The bytes with a correct CRC.
std::vector<std::uint8_t> mended(std::vector<std::uint8_t> bytes) {
    const std::size_t end = bytes.size() - 4;
    store(&bytes[end], crc32c(std::span(bytes).first(end)));
    return bytes;
}

TEST(CalibrationFileTest, WhatIsWrittenIsRead) {
    const ChipCalibration c = example();
    EXPECT_EQ(decode_chip_calibration(encode_chip_calibration(c), "chip.stcal"), c);
    ChipCalibration unknown = c;
    unknown.chip = {};
    EXPECT_EQ(decode_chip_calibration(encode_chip_calibration(unknown), "chip.stcal"), unknown);
    EXPECT_EQ(decode_chip_calibration(encode_chip_calibration(bent_example()), "chip.stcal"),
              bent_example());
}

// The numbers of docs/calibration.md.
TEST(CalibrationFileTest, HasTheLayoutOfItsPage) {
    const auto bytes = encode_chip_calibration(example());
    ASSERT_EQ(bytes.size(), 40U + 2 + 6 * 29 + 4);
    EXPECT_EQ(load<std::uint16_t>(&bytes[12]), 2);     // rows
    EXPECT_EQ(load<std::uint16_t>(&bytes[14]), 3);     // columns
    EXPECT_EQ(bytes[18], 12);                          // bits
    EXPECT_EQ(load<std::uint32_t>(&bytes[20]), 7U);    // device id
    EXPECT_EQ(load<std::uint32_t>(&bytes[28]), 100U);  // flats
    EXPECT_EQ(bytes[40], 't');
    EXPECT_EQ(load<std::uint32_t>(&bytes[42]), 0x3F800000U);  // gain 1 of the first site
    EXPECT_EQ(bytes[42 + 6 * 28 + 4], 1);                     // the defect
}

TEST(CalibrationFileTest, AResponseTableMakesItVersionTwo) {
    const auto bytes = encode_chip_calibration(example());
    EXPECT_EQ(load<std::uint16_t>(&bytes[8]), 1);
    const auto bent = encode_chip_calibration(bent_example());
    ASSERT_EQ(bent.size(), bytes.size() + 4 * 8);
    EXPECT_EQ(load<std::uint16_t>(&bent[8]), 2);
    const std::size_t table = 42 + 6 * 29;
    EXPECT_EQ(load<std::uint32_t>(&bent[table]), 0xBF800000U);       // -1
    EXPECT_EQ(load<std::uint32_t>(&bent[table + 20]), 0x3E800000U);  // 0.25
}

TEST(CalibrationFileTest, RefusesATableThatDoesNotRise) {
    const auto bytes = encode_chip_calibration(bent_example());
    const auto with = [&](std::size_t at, std::uint32_t value) {
        auto changed = bytes;
        store(&changed[at], value);
        return mended(changed);
    };
    const std::size_t table = 42 + 6 * 29;
    constexpr std::uint32_t kNan = 0x7FC00000, kMinusOne = 0xBF800000;
    expect_parts(message(with(table + 4, kMinusOne)), {"linear DN -1 after -1", "rises"});
    expect_parts(message(with(table + 8, kNan)), {"linear DN nan after 1"});
    expect_parts(message(with(table + 16, kMinusOne)), {"variance -1 of the response table"});
    // Of another bit depth the file has another size.
    auto deeper = bytes;
    deeper[18] = 3;
    expect_parts(message(mended(deeper)), {"truncated"});
}

TEST(CalibrationFileTest, NamesATruncatedFile) {
    for (const auto& bytes :
         {encode_chip_calibration(example()), encode_chip_calibration(bent_example())})
        for (std::size_t n = 1; n < bytes.size(); ++n)
            expect_parts(message({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n)}),
                         {"chip.stcal: byte " + std::to_string(n) + ": ", "truncated"});
}

TEST(CalibrationFileTest, IsFoundBesideAStream) {
    const TemporaryFolder folder;
    EXPECT_EQ(calibration_beside(folder / "clip.stipple"), "");
    std::ofstream(folder / "clip.stcal") << "x";
    EXPECT_EQ(calibration_beside(folder / "clip.stipple"), folder / "clip.stcal");
    EXPECT_EQ(calibration_beside(folder / "clip"), folder / "clip.stcal");
    EXPECT_EQ(calibration_beside(folder / "clip_2.stipple"), "");
}

TEST(CalibrationFileTest, NamesDamageAndForeignFiles) {
    const auto bytes = encode_chip_calibration(example());
    expect_parts(message({}), {"chip.stcal: is not a calibration file"});
    for (std::size_t i = 40; i < bytes.size(); ++i) {
        auto changed = bytes;
        changed[i] ^= 0x10U;
        expect_parts(message(changed), {"chip.stcal", "damaged"});
    }
    auto longer = bytes;
    longer.push_back(0);
    expect_parts(message(longer), {"after the end"});
    auto foreign = bytes;
    foreign[1] = 'X';
    expect_parts(message(foreign), {"not a calibration file"});
    auto newer = bytes;
    newer[8] = 3;
    expect_parts(message(mended(newer)), {"version 3"});
}

TEST(CalibrationFileTest, RefusesValuesOutsideTheirLimits) {
    const auto bytes = encode_chip_calibration(example());
    const auto with = [&](std::size_t at, std::uint32_t value) {
        auto changed = bytes;
        store(&changed[at], value);
        return mended(changed);
    };
    constexpr std::uint32_t kNan = 0x7FC00000, kMinusOne = 0xBF800000, kInfinity = 0x7F800000;
    expect_parts(message(with(42, kNan)), {"byte 46", "gain nan is outside"});
    expect_parts(message(with(42, 0)), {"gain 0 is outside"});
    expect_parts(message(with(42 + 24, kMinusOne)), {"gain variance -1 is outside"});
    expect_parts(message(with(42 + 48, kInfinity)), {"offset inf is outside"});
    expect_parts(message(with(36, 3000)), {"a name of 3000 bytes"});
    expect_parts(message(with(12, 0)), {"an array of 0 x 0"});
    expect_parts(message(with(16, 5)), {"in 5 planes"});
}

TEST(CalibrationFileTest, NamesAMissingFile) {
    const TemporaryFolder folder;
    expect_parts(
        message_of<InputError>([&] { return read_chip_calibration(folder / "none.stcal"); }),
        {"none.stcal"});
}

}  // namespace
}  // namespace stipple
