#include "io/npy_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "tests/io/npy_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

NpyHeader parse(const std::string& file, std::uint64_t file_bytes) {
    return parse_npy_header(std::as_bytes(std::span(file)), file_bytes, "clip.npy");
}
NpyHeader parse(const std::string& file) {
    return parse(file, file.size());
}

std::string problem_of(const std::string& file) {
    return message_of<InputError>([&] { return parse(file); });
}
std::string problem_of_shape(std::string_view shape) {
    return problem_of(npy_file("<f4", shape, ""));
}

TEST(NpyHeaderTest, ReadsMonoAndColourOfEveryType) {
    struct Case {
        const char* descr;
        NpyType type;
        std::size_t bytes;
    };
    for (const Case& c : {Case{"|u1", NpyType::kUint8, 1}, Case{"<u2", NpyType::kUint16, 2},
                          Case{"<f2", NpyType::kHalf, 2}, Case{"<f4", NpyType::kFloat, 4},
                          Case{"<f8", NpyType::kDouble, 8}}) {
        const auto mono = parse(npy_file(c.descr, "(2, 3, 5)", std::string(30 * c.bytes, 'x')));
        EXPECT_EQ(mono.type, c.type);
        EXPECT_EQ(mono.slots, 2);
        EXPECT_EQ(mono.shape, (FrameShape{3, 5, 1}));
        EXPECT_EQ(mono.data_offset, 128U);
        const auto rgb = parse(npy_file(c.descr, "(2, 3, 5, 3)", std::string(90 * c.bytes, 'x')));
        EXPECT_EQ(rgb.shape, (FrameShape{3, 5, 3}));
    }
}

TEST(NpyHeaderTest, ReadsVersion2AndAnyOrderSpacingAndQuotes) {
    const std::string dictionary =
        "{\"shape\":(1,1,2),'fortran_order' : False , \"descr\":\"<u2\"}\n";
    std::string file("\x93NUMPY\x02\x00", 8);
    file += static_cast<char>(dictionary.size());
    file.append(3, '\0').append(dictionary).append("abcd");
    EXPECT_EQ(parse(file).shape, (FrameShape{1, 2, 1}));
}

TEST(NpyHeaderTest, FormatsWhatItReadsAtAFixedLength) {
    constexpr int kMax = std::numeric_limits<int>::max();
    for (const FrameShape shape :
         {FrameShape{1, 1, 1}, FrameShape{480, 640, 3}, FrameShape{4096, 65535, 1}})
        for (const int slots : {1, 7, kMax}) {
            const std::string header = format_npy_header(slots, shape);
            ASSERT_EQ(header.size(), 128U);
            const auto parsed =
                parse(header, 128 + static_cast<std::uint64_t>(slots) * shape.sites() * 4);
            EXPECT_EQ(parsed.slots, slots);
            EXPECT_EQ(parsed.shape, shape);
            EXPECT_EQ(parsed.type, NpyType::kFloat);
        }
}

TEST(NpyHeaderTest, ACommentFollowsTheDictionary) {
    const std::string header = format_npy_header(64, {4096, 21845, 3}, std::string(32, 'c'));
    ASSERT_EQ(header.size(), 128U);
    EXPECT_NE(header.find(", } # " + std::string(32, 'c')), std::string::npos);
    EXPECT_EQ(parse(header, 128 + 64ULL * 4096 * 21845 * 3 * 4).slots, 64);
    expect_parts(
        problem_of(npy_with_dictionary(
            "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1)} # a\nb", "abcd")),
        {"text follows the dictionary"});
}

TEST(NpyHeaderTest, RefusesForeignAndCutOffHeaders) {
    expect_parts(problem_of(""), {"clip.npy: is not a .npy file"});
    expect_parts(problem_of("PK\x03\x04"), {"is not a .npy file"});
    const std::string file = npy_file("<f4", "(1, 1, 1)", "abcd");
    for (std::size_t length = 6; length < 128; ++length)
        expect_parts(problem_of(file.substr(0, length)), {"ends within its header"});
    std::string future = file;
    future[6] = 4;
    expect_parts(problem_of(future), {"offset 6: .npy version 4 is unknown"});
    std::string endless = file;
    endless[6] = 2;
    endless.replace(8, 4, "\xff\xff\xff\xff");
    expect_parts(problem_of(endless), {"offset 8", "too long"});
}

TEST(NpyHeaderTest, RefusesMalformedDictionaries) {
    for (const char* dictionary :
         {"", "{", "{}", "[1]", "{'descr': '<f4'}", "{'descr' '<f4'}", "{'descr': '<f4",
          "{'descr': '<f4', 'fortran_order': 0, 'shape': (1, 1, 1)}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (1, -1, 1)}",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1)} x",
          "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 1), 'more': 'x'}",
          "{'descr': [('r', '<f4')], 'fortran_order': False, 'shape': (1, 1, 1)}"})
        expect_parts(problem_of(npy_with_dictionary(dictionary, "abcd")),
                     {"clip.npy: malformed .npy header: "});
}

TEST(NpyHeaderTest, RefusesTypesThatItWouldMisread) {
    for (const char* descr : {">u2", ">f4", "<i2", "|b1", "<c8", "|O", "<u4", "|S4"})
        expect_parts(problem_of(npy_file(descr, "(1, 1, 1)", "abcd")),
                     {std::string("type \"") + descr + '"', "little-endian"});
    for (const auto& [descr, type] : {std::pair(">u2", "<u2"),
                                      {">f8", "<f8"},
                                      {"|b1", "u1"},
                                      {"<i2", "u2"},
                                      {"<i4", "f4"},
                                      {"", "f4"}})
        expect_parts(problem_of(npy_file(descr, "(1, 1, 1)", "abcd")),
                     {std::string("video.astype(\"") + type + "\")"});
    expect_parts(problem_of(npy_with_dictionary(
                     "{'descr': '<f4', 'fortran_order': True, 'shape': (1, 1, 1), }", "abcd")),
                 {"Fortran order"});
}

TEST(NpyHeaderTest, RefusesWrongAndOverflowingShapes) {
    expect_parts(problem_of_shape("(5,)"), {"shape (5) is not (T,H,W), (T,H,W,3) or (H,W)"});
    expect_parts(problem_of_shape("(0, 5)"), {"a frame of 0 rows and 5 columns is outside"});
    expect_parts(problem_of_shape("()"), {"shape () is not"});
    expect_parts(problem_of_shape("(9, 3, 5, 4)"), {"is not", "video.transpose(0, 2, 3, 1)"});
    expect_parts(problem_of_shape("(1, 2, 3, 4)"), {"shape (1, 2, 3, 4) is not"});
    expect_parts(problem_of_shape("(1, 2, 3, 3, 3)"), {"is not (T,H,W)"});
    expect_parts(problem_of_shape("(0, 5, 5)"), {"holds no frames"});
    expect_parts(problem_of_shape("(1, 0, 5)"), {"a frame of 0 rows and 5 columns is outside"});
    expect_parts(problem_of_shape("(1, 65536, 5)"), {"65536 rows"});
    expect_parts(problem_of_shape("(1, 65535, 65535)"), {"outside"});
    expect_parts(problem_of_shape("(4294967296, 4294967296, 4294967296)"), {"too many"});
    expect_parts(problem_of_shape("(1, 18446744073709551615, 2)"), {"outside"});
    expect_parts(problem_of_shape("(1, 18446744073709551616, 2)"), {"malformed"});
}

TEST(NpyHeaderTest, AnImageIsOneFrame) {
    const auto file = npy_file("<u2", "(2, 3)", std::string(12, '\0'));
    const NpyHeader header = parse_npy_header(std::as_bytes(std::span(file)), file.size(), "a");
    EXPECT_EQ(header.slots, 1);
    EXPECT_EQ(header.shape, (FrameShape{2, 3, 1}));
}

TEST(NpyHeaderTest, SeveralArraysInAFileAreNoVideo) {
    const auto image = npy_file("|u1", "(2, 3)", std::string(6, '\0'));
    expect_parts(problem_of(image + image), {"need 6 bytes", "several arrays were saved into it"});
}

TEST(NpyHeaderTest, RefusesALengthThatDoesNotMatch) {
    for (const std::size_t bytes : {0U, 23U, 25U, 48U})
        expect_parts(problem_of(npy_file("<f4", "(1, 2, 3)", std::string(bytes, 'x'))),
                     {"1 frames need 24 bytes, but the file holds " + std::to_string(bytes)});
}

}  // namespace
}  // namespace stipple
