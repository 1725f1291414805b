#include "io/npy_file.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/error.h"
#include "tests/io/npy_bytes.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

NpyVolume parse(const std::string& file) {
    return parse_npy_volume(std::as_bytes(std::span(file)), "v.npy");
}

std::string problem_of(const std::string& file) {
    return message_of<InputError>([&] { return parse(file); });
}

template <typename Value>
void expect_read(const char* descr, const std::vector<Value>& values) {
    const NpyVolume volume = parse(npy_file(descr, "(1, 2, 2)", bytes_of(values)));
    EXPECT_EQ(volume.layers, 1);
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(volume.at(0, i / 2, i % 2),
                  static_cast<double>(values[static_cast<std::size_t>(i)]))
            << descr;
}

TEST(NpyVolumeTest, ReadsBooleansIntegersAndFloats) {
    expect_read<std::uint8_t>("|b1", {0, 1, 1, 0});
    expect_read<std::uint8_t>("|u1", {0, 1, 255, 3});
    expect_read<std::int8_t>("|i1", {0, 1, -128, 3});
    expect_read<std::uint16_t>("<u2", {0, 1, 65535, 3});
    expect_read<std::int16_t>("<i2", {0, 1, -32768, 3});
    expect_read<std::uint32_t>("<u4", {0, 1, 4294967295U, 3});
    expect_read<std::int32_t>("<i4", {0, 1, -5, 3});
    expect_read<std::uint64_t>("<u8", {0, 1, std::uint64_t{1} << 52U, 3});
    expect_read<std::int64_t>("<i8", {0, 1, -5, 3});
    expect_read<float>("<f4", {0, 1, 0.5F, -3});
    expect_read<double>("<f8", {0, 1, 0.1, -3});
    const std::vector<std::uint16_t> halves = {0, 0x3C00, 0x3800, 0xC200};  // 0, 1, 0.5, -3
    const NpyVolume volume = parse(npy_file("<f2", "(2, 1, 2)", bytes_of(halves)));
    EXPECT_EQ(volume.values, (std::vector<double>{0, 1, 0.5, -3}));
    EXPECT_EQ(volume.at(1, 0, 0), 0.5);
}

TEST(NpyVolumeTest, RefusesWhatIsNoVolume) {
    const std::string four(4, '\0');
    expect_parts(problem_of(npy_file("|u1", "(2, 2)", four)), {"v.npy", "2 dimensions"});
    expect_parts(problem_of(npy_file("|u1", "(1, 2, 2, 1)", four)), {"4 dimensions"});
    expect_parts(problem_of(npy_file("|u1", "(0, 2, 2)", "")), {"(0, 2, 2)", "sides"});
    expect_parts(problem_of(npy_file("|u1", "(65536, 1, 1)", four)), {"sides"});
    expect_parts(problem_of(npy_file("|u1", "(60000, 60000, 60000)", four)), {"2^26"});
    expect_parts(problem_of(npy_file("|u1", "(1, 2, 3)", four)), {"need 6 bytes", "holds 4"});
    expect_parts(problem_of(npy_file("|u1", "(1, 1, 3)", four)), {"need 3 bytes", "holds 4"});
    expect_parts(problem_of(npy_file(">u2", "(1, 1, 2)", four)), {">u2"});
    expect_parts(problem_of(npy_file("<c8", "(1, 2, 2)", four)), {"<c8"});
    expect_parts(problem_of("no numpy"), {"not a .npy"});
}

TEST(NpyVolumeTest, ReadsFortranOrder) {
    // Of numpy.asfortranarray(numpy.arange(24).reshape(2, 3, 4)): the first index runs fastest.
    std::string data;
    for (int col = 0; col < 4; ++col)
        for (int row = 0; row < 3; ++row)
            for (int layer = 0; layer < 2; ++layer)
                data += static_cast<char>((layer * 3 + row) * 4 + col);
    const std::string file =
        npy_with_dictionary("{'descr': '|u1', 'fortran_order': True, 'shape': (2, 3, 4), }", data);
    const NpyVolume volume = parse_npy_volume(std::as_bytes(std::span(file)), "v.npy");
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(volume.values[i], static_cast<double>(i));
}

TEST(NpyVolumeTest, NamesAFileThatIsNotThere) {
    const TemporaryFolder folder;
    expect_parts(message_of<InputError>([&] { return read_npy_volume(folder / "none.npy"); }),
                 {"none.npy"});
}

}  // namespace
}  // namespace stipple
