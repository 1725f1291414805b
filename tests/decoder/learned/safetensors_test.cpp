#include "decoder/learned/safetensors.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "stream/little_endian.h"
#include "tests/decoder/learned/plain_network.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

/// `{"t": {"dtype": ...}}`
std::string header_of(const std::string& dtype, const std::string& shape, int begin, int end) {
    return R"({"t":{"dtype":")" + dtype + R"(","shape":)" + shape + R"(,"data_offsets":[)" +
           std::to_string(begin) + "," + std::to_string(end) + "]}}";
}

std::string error_of(const std::vector<std::uint8_t>& bytes) {
    return message_of<InputError>([&] { return parse_safetensors(bytes, "net.st"); });
}

std::string error_of(const std::string& header, std::size_t data_bytes) {
    return error_of(safetensors_file(header, std::vector<std::uint8_t>(data_bytes)));
}

TEST(SafetensorsTest, ReadsSinglePrecision) {
    const Tensors tensors{{"a", {.shape = {2, 1}, .values = {1.5F, -0.25F}}},
                          {"b.weight", {.shape = {1}, .values = {3e30F}}}};
    const TensorFile file = parse_safetensors(safetensors_file(tensors), "net.st");
    ASSERT_EQ(file.tensors.size(), 2U);
    for (const auto& [name, tensor] : tensors) {
        EXPECT_EQ(file.tensors.at(name).shape, tensor.shape);
        EXPECT_EQ(file.tensors.at(name).values, tensor.values);
    }
    EXPECT_EQ(file.metadata,
              (std::map<std::string, std::string>{{"format", "pt"}, {"inputs", "1"}}));
}

/// IEEE 754-2008, binary16: the smallest subnormal and normal, the largest of both, 1/3, 1, -2.
TEST(SafetensorsTest, ReadsHalfPrecision) {
    std::vector<std::uint8_t> data;
    for (const unsigned bits :
         {0x0000U, 0x8000U, 0x0001U, 0x03FFU, 0x0400U, 0x3555U, 0x3C00U, 0xC000U, 0x7BFFU, 0xFBFFU})
        append(data, static_cast<std::uint16_t>(bits));
    const auto file =
        parse_safetensors(safetensors_file(header_of("F16", "[5,2]", 0, 20) + "  ", data), "net");
    EXPECT_EQ(file.tensors.at("t").values,
              (std::vector<float>{0, -0.0F, 0x1p-24F, 0x3FFp-24F, 0x1p-14F, 0x555p-12F, 1, -2,
                                  65504, -65504}));
}

TEST(SafetensorsTest, NamesWhatIsWrongWithTheHeader) {
    expect_parts(error_of(std::vector<std::uint8_t>(7)), {"net.st: ", "less than 8 bytes"});
    std::vector<std::uint8_t> bytes = safetensors_file(header_of("F32", "[1]", 0, 4), {});
    bytes.resize(40);
    expect_parts(error_of(bytes), {"net.st: ", "ends within its header", "copy the file again"});
    for (const std::uint64_t length : {std::uint64_t{1'000'001}, ~std::uint64_t{0}}) {
        store(bytes.data(), length);
        expect_parts(error_of(bytes), {"net.st: ", std::to_string(length)});
    }
    for (const std::string header : {"", "{", "[]", "[1]", "3", "{}x", "{\"t\":3}", "{\"t\":{}}",
                                     "{\"__metadata__\":{\"a\":1}}"})
        expect_parts(error_of(header, 0), {"net.st"});
    expect_parts(error_of(std::string(500'000, '['), 0), {"net.st: ", "not JSON"});
}

TEST(SafetensorsTest, NamesWhatIsWrongWithATensor) {
    const std::string t = "net.st: tensor \"t\": ";
    expect_parts(error_of(header_of("BF16", "[2]", 0, 4), 4), {t, "F16", "F32"});
    for (const char* shape :
         {"[2]", "[0]", "[1,1,2]", "[4294967296,4294967296]", "[18446744073709551615]"})
        expect_parts(error_of(header_of("F32", shape, 0, 4), 4), {t, "shape", "0..4"});
    for (const char* shape : {"[-1]", "[1.0]", "[1e300]", "[\"1\"]", "[null]"})
        expect_parts(error_of(header_of("F32", shape, 0, 4), 4), {t, "no integers"});
    expect_parts(error_of(header_of("F32", "[1]", 4, 0), 4), {t, "4..0"});
    expect_parts(error_of(header_of("F32", "[1]", 0, 3), 4), {t, "0..3"});
    for (const char* offsets : {"[-4,0]", "[0.5,4]"})
        expect_parts(error_of(R"({"t":{"dtype":"F32","shape":[1],"data_offsets":)" +
                                  std::string(offsets) + "}}",
                              4),
                     {t, "no integers"});
}

TEST(SafetensorsTest, TensorsFillTheFile) {
    expect_parts(error_of(header_of("F32", "[2]", 0, 8), 7), {"7 bytes of data", "have 8"});
    expect_parts(error_of(header_of("F32", "[2]", 0, 8), 9), {"9 bytes of data", "have 8"});
    expect_parts(error_of(header_of("F32", "[2]", 4, 12), 12), {"gap", "byte 0"});
    expect_parts(error_of(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
                          R"("b":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})",
                          12),
                 {"overlap", "byte 8"});
}

TEST(SafetensorsTest, RefusesWhatIsNoFiniteNumber) {
    using Limits = std::numeric_limits<float>;
    for (const float value : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()})
        expect_parts(
            error_of(safetensors_file(Tensors{{"t", {.shape = {3}, .values = {0, value, 0}}}})),
            {"net.st: tensor \"t\": ", " at 1", "finite"});
    std::vector<std::uint8_t> half{0x00, 0x7C};
    expect_parts(error_of(safetensors_file(header_of("F16", "[1]", 0, 2), half)), {"inf"});
    half[0] = 1;
    expect_parts(error_of(safetensors_file(header_of("F16", "[1]", 0, 2), half)), {"nan"});
}

}  // namespace
}  // namespace stipple
