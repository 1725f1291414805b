#include "stream/header_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "tests/stream/stream_bytes.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

StreamHeader decode(const Bytes& bytes) {
    const std::size_t length = header_bytes(
        std::span(bytes).first(std::min(bytes.size(), kHeaderStartBytes)), "a.stipple");
    EXPECT_EQ(length, bytes.size());
    return decode_header(bytes, "a.stipple");
}

void seal(Bytes& header) {
    store(&header[header.size() - 4], crc32c(std::span(header).first(header.size() - 4)));
}

/// A header with `value` at `offset` and a good CRC is refused there, with `problem`.
template <Stored T>
void expect_refused(std::size_t offset, T value, const std::string& problem) {
    Bytes bytes = encode_header(varied_header(), "a.stipple");
    store(&bytes[offset], value);
    seal(bytes);
    expect_parts(message_of<InputError>([&] { return decode(bytes); }),
                 {"a.stipple: byte " + std::to_string(offset) + ": " + problem});
}

TEST(HeaderCodecTest, DecodesWhatItEncodes) {
    StreamHeader header = varied_header({65535, 3, 4}, 16);
    header.slot_us = 0.1;
    header.calibration = {1, Rounding::kFloor, 0.5, 1e-12, 0, 1e12, 1.0 / 3};
    header.schedule_name = std::string(64, 'n');
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.schedule_name = "";
    header.provenance = "";
    EXPECT_EQ(decode(encode_header(header, "")), header);
}

TEST(HeaderCodecTest, AGeneratorOutOfProportionToTheFileIsRefused) {
    const StreamHeader header = random_header({9, 11, 1}, 7);
    Bytes bytes = encode_header(header, "");
    const ScheduleUse small_file{.input_bytes = bytes.size()};
    EXPECT_EQ(decode_header(bytes, "a.stipple", small_file), header);
    store(&bytes[16], std::uint16_t{2160});
    store(&bytes[18], std::uint16_t{3840});
    seal(bytes);
    expect_parts(
        message_of<InputError>([&] { return decode_header(bytes, "a.stipple", small_file); }),
        {"a.stipple", "for its schedule", "max_memory = "});
}

TEST(HeaderCodecTest, IntegersOutsideTheirLimitsAreRefused) {
    using U8 = std::uint8_t;
    using U16 = std::uint16_t;
    expect_refused(16, U16{0}, "rows 0 is outside 1..65535");
    expect_refused(18, U16{0}, "columns 0 is outside 1..65535");
    expect_refused(20, U8{0}, "planes 0 is outside 1..4");
    expect_refused(20, U8{5}, "planes 5 is outside 1..4");
    expect_refused(21, U8{5}, "colour filter array 5 is outside 0..4");
    expect_refused(85, U8{2}, "calibration section 2 is outside 0..1");
    expect_refused(22, U8{0}, "bit depth 0 is outside 1..16");
    expect_refused(22, U8{17}, "bit depth 17 is outside 1..16");
    expect_refused(23, U8{2}, "rounding 2 is outside 0..1");
    expect_refused(84, U8{2}, "schedule kind 2 is outside 0..1");
    expect_refused(16, std::uint32_t{0xFFFFFFFF}, "rows x columns x planes 4294836225 is outside");
    for (const std::size_t reserved : {10U, 11U, 86U, 87U})
        expect_refused(reserved, U8{1}, "reserved byte is not zero");
}

StreamHeader calibrated_header() {
    StreamHeader header = varied_header({4, 5, 1}, 12);
    header.cfa = ColourFilter::kGbrg;
    header.calibration.dark_e_per_slot = 0.25;
    header.calibration.tile = {1, 2, {{1, 1}, {0.125, 8}}};
    return header;
}

TEST(HeaderCodecTest, DecodesACalibrationSectionAndAColourFilterArray) {
    StreamHeader header = calibrated_header();
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.calibration.tile = {};
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header = calibrated_header();
    header.calibration.dark_e_per_slot = 0;
    EXPECT_EQ(decode(encode_header(header, "")), header);
    // 8 bytes of dark signal, 4 of the tile's size, 16 a pixel.
    const auto bytes = encode_header(header, "");
    header.calibration.tile = {};
    EXPECT_EQ(encode_header(header, "").size() + 12 + 2 * 16, bytes.size());
}

TEST(HeaderCodecTest, AColourFilterArrayHasOnePlane) {
    StreamHeader header = varied_header({4, 5, 3}, 8);
    header.cfa = ColourFilter::kRggb;
    expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                 {"a: byte 21: a colour filter array has one plane, not 3"});
}

TEST(HeaderCodecTest, CalibrationOutsideItsLimitsIsNotWritten) {
    const auto refusal = [](double dark, CalibrationTile tile) {
        StreamHeader header = calibrated_header();
        header.calibration.dark_e_per_slot = dark;
        header.calibration.tile = std::move(tile);
        return message_of<InputError>([&] { return encode_header(header, "a"); });
    };
    expect_parts(refusal(-1, {}), {"dark electrons per slot -1"});
    expect_parts(refusal(std::nan(""), {}), {"dark electrons per slot nan"});
    expect_parts(refusal(1, {1, 1, {{0, 1}}}), {"relative responsivity or gain 0"});
    expect_parts(refusal(1, {1, 1, {{1, 1e7}}}), {"relative responsivity or gain 10000000"});
    expect_parts(refusal(1, {1, 0, {}}), {"calibration tile of 1 x 0"});
    expect_parts(refusal(1, {70000, 1, {}}), {"calibration tile of 70000 x 1"});
    expect_parts(refusal(1, {2, 2, {{1, 1}}}), {"do not match"});
}

TEST(HeaderCodecTest, ACalibrationSectionThatIsDamagedIsRefusedAtItsPlace) {
    const Bytes good = encode_header(calibrated_header(), "");
    const std::size_t section = good.size() - 4 - 12 - 32;
    const auto refusal = [&](std::size_t offset, auto value) {
        Bytes bytes = good;
        store(&bytes[offset], value);
        seal(bytes);
        return message_of<InputError>([&] { return decode(bytes); });
    };
    const auto at = [](std::size_t offset) { return "byte " + std::to_string(offset) + ": "; };
    expect_parts(refusal(section, -1.0), {at(section + 8) + "dark electrons"});
    expect_parts(refusal(section + 8, std::uint16_t{0}),
                 {at(section + 12) + "calibration tile of 0"});
    expect_parts(refusal(section + 10, std::uint16_t{3}), {"does not fill its section"});
    expect_parts(refusal(section + 12, 0.0), {at(section + 28) + "relative responsivity"});
    expect_parts(refusal(85, std::uint8_t{0}), {"not the sum of its parts"});
    Bytes nothing = encode_header(varied_header(), "");
    nothing[85] = 1;
    seal(nothing);
    expect_parts(message_of<InputError>([&] { return decode(nothing); }),
                 {"not the sum of its parts"});
}

TEST(HeaderCodecTest, ACalibrationSectionThatSaysNothingIsRefused) {
    StreamHeader header = calibrated_header();
    header.calibration.tile = {};
    Bytes bytes = encode_header(header, "");
    store(&bytes[bytes.size() - 16], 0.0);
    seal(bytes);
    expect_parts(message_of<InputError>([&] { return decode(bytes); }), {"says nothing"});
}

TEST(HeaderCodecTest, WeightsAndTheAbsenceOfNoiseMakeVersion3) {
    StreamHeader header = weighted_header();
    EXPECT_EQ(encode_header(header, "")[8], 3);
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.calibration.noise_free = true;
    header.calibration.dark_e_per_slot = 1;
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.schedule = varied_schedule();
    EXPECT_EQ(encode_header(header, "")[8], 3);
    EXPECT_EQ(decode(encode_header(header, "")), header);
    header.calibration.noise_free = false;
    EXPECT_EQ(encode_header(header, "")[8], 2);
}

TEST(HeaderCodecTest, WeightsThatAreDamagedAreRefusedAtTheirPlace) {
    const Bytes good = encode_header(weighted_header(), "");
    const std::size_t section = good.size() - 4 - 4 * 30;
    const auto refusal = [&](std::size_t offset, auto value) {
        Bytes bytes = good;
        store(&bytes[offset], value);
        seal(bytes);
        return message_of<InputError>([&] { return decode(bytes); });
    };
    const std::string at = "byte " + std::to_string(section) + ": ";
    const std::size_t open = section + 4 * 18;  // slot 3 of pixel 0, whose slot 2 is closed
    expect_parts(refusal(open, 0.0F), {at, "pixel (0, 0) slot 3", "open slot"});
    expect_parts(refusal(open, std::nanf("")), {at, "nan"});
    expect_parts(refusal(open - 4 * 6, 1.0F), {at, "pixel (0, 0) slot 2", "closed slot"});
    expect_parts(refusal(85, std::uint8_t{1}), {"not the sum of its parts"});
    expect_parts(refusal(86, std::uint8_t{2}), {"byte 86: weights section 2 is outside 0..1"});
    expect_parts(refusal(87, std::uint8_t{2}), {"byte 87: absence of noise 2 is outside 0..1"});
    expect_parts(refusal(86, std::uint8_t{0}), {"byte 8: version 3 has weights"});
    expect_parts(refusal(8, std::uint8_t{2}), {"byte 86: reserved byte is not zero"});
    Bytes ones = good;
    for (std::size_t i = 0; i < 30; ++i)
        if (load<float>(&ones[section + 4 * i]) != 0) store(&ones[section + 4 * i], 1.0F);
    seal(ones);
    expect_parts(message_of<InputError>([&] { return decode(ones); }), {at, "says nothing"});
}

TEST(HeaderCodecTest, ARandomScheduleHasNoWeights) {
    StreamHeader header = random_header({2, 2, 1}, 7);
    header.schedule.set_weights(std::vector<float>(4 * 15, 0.5F));
    expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                 {"a: byte 86: a random schedule has no weights"});
}

TEST(HeaderCodecTest, NumbersThatAreNotPhysicalAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const std::size_t offset : {24U, 32U, 40U, 48U, 56U, 64U})
        for (const double value : {nan, infinity, -infinity, -1.0, 1.1e12})
            expect_refused(offset, value, "");
    for (const std::size_t above_zero : {24U, 40U, 56U, 64U}) expect_refused(above_zero, 0.0, "");
    expect_refused(24, -5.0, "slot duration in us -5 is outside 1e-12..1e+12");
}

TEST(HeaderCodecTest, LengthsMustAddUp) {
    expect_refused(72, std::uint32_t{65}, "bytes of the schedule name 65 is outside 0..64");
    expect_refused(76, (1U << 20U) + 1, "bytes of the provenance text 1048577 is outside");
    expect_refused(76, 100000U, "bytes of the provenance text 100000 exceeds the header");
    expect_refused(80, 0U, "bytes of the schedule section 0 is outside 1..");
    expect_refused(80, 0x20000000U, "bytes of the schedule section 536870912 is outside");
    Bytes bytes = encode_header(varied_header(), "");
    --bytes[72];
    seal(bytes);
    expect_parts(message_of<InputError>([&] { return decode(bytes); }),
                 {"a.stipple: byte 12: header bytes are not the sum of its parts"});
}

TEST(HeaderCodecTest, TextsThatWouldSteerATerminalAreRefused) {
    for (const char* bad : {"\x1B[2J", "a\nb", "\xC2\x9B", "\xFF", "\xC0\xAF", "\xED\xA0\x80",
                            "\xF4\x90\x80\x80", "\xC3"}) {
        StreamHeader header = varied_header();
        header.schedule_name = bad;
        expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                     {"a: byte 92: schedule name is not UTF-8 without control characters"});
    }
    StreamHeader header = varied_header();
    header.provenance = "\x7F";
    expect_parts(message_of<InputError>([&] { return encode_header(header, "a"); }),
                 {"provenance text is not UTF-8"});
    header.provenance = "tab\t and lines\r\n \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x98\x80";
    EXPECT_EQ(decode(encode_header(header, "")), header);
}

TEST(HeaderCodecTest, AForeignFileIsCalledForeign) {
    const auto refusal = [](const std::string& start) {
        return message_of<InputError>([&] {
            return header_bytes({reinterpret_cast<const std::uint8_t*>(start.data()), start.size()},
                                "a");
        });
    };
    EXPECT_EQ(refusal(""), "a: byte 0: the file is empty");
    EXPECT_EQ(refusal("\x93NUMPY"), "a: byte 0: this is not a sample stream (.stipple)");
    for (std::size_t length = 1; length < 16; ++length)
        expect_parts(refusal(std::string(length, '#')), {"this is not a sample stream"});
    expect_parts(refusal("\x89STPL\n\x1A\x01\0\0\0\0\0\0\0\0"), {"text-mode transfer"});
    expect_parts(refusal("\tSTPL\r\n\x1A"), {"text-mode transfer"});
    expect_parts(refusal(std::string("\x89STPL\r\n\x1A\x05\0\0\0\0\0\0\0", 16)),
                 {"a: byte 8: version 5 of the sample stream; this program reads versions 1 to 4"});
    expect_parts(refusal(std::string("\x89STPL\r\n\x1A\x01\0\0\0\xFF\xFF\xFF\xFF", 16)),
                 {"a: byte 12: header bytes 4294967295 is outside"});
}

TEST(HeaderCodecTest, AHeaderTakesNoMemoryThatTheFileDoesNotHave) {
    std::string bytes("\x89STPL\r\n\x1A\x01\0\0\0\0\0\0\x10 and so on", 26);
    expect_parts(message_of<InputError>([&] { return read_bytes(bytes); }),
                 {"byte 26: the file ends within its header of 268435456 bytes"});
}

}  // namespace
}  // namespace stipple
