#include "io/npz_volume.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/input_file.h"
#include "io/mat_volume.h"
#include "io/named_arrays.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

std::vector<NamedArray> two_arrays() {
    std::vector<float> values(12);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 0.5F * static_cast<float>(i);
    return {{"mask", {2, 2, 3}, values},
            {"open", {1, 3, 1}, std::vector<std::uint8_t>{0, 1, 255}},
            {"number", {}, std::vector<double>{0.1}}};
}

template <auto kWrite>
std::filesystem::path write_to(const std::filesystem::path& file) {
    OutputFile output(file, file.string());
    kWrite(output, two_arrays(), file.string());
    output.close();
    return file;
}

void expect_mask(const NpyVolume& volume) {
    EXPECT_EQ(std::vector<int>({volume.layers, volume.rows, volume.cols}),
              std::vector<int>({2, 2, 3}));
    for (int i = 0; i < 12; ++i) EXPECT_EQ(volume.at(i / 6, i / 3 % 2, i % 3), 0.5 * i);
}

TEST(NpzVolumeTest, ReadsWhatIsWritten) {
    const TemporaryFolder folder;
    const auto file = write_to<write_npz>(folder / "a.NPZ");
    EXPECT_TRUE(is_npz(file));
    expect_mask(read_npz_volume(file, "mask"));
    EXPECT_EQ(read_npz_volume(file, "open").values, (std::vector<double>{0, 1, 255}));
}

TEST(NpzVolumeTest, AMatFileHasTheSameArrays) {
    const TemporaryFolder folder;
    const auto file = write_to<write_mat>(folder / "a.mat");
    EXPECT_EQ(std::filesystem::file_size(file) % 8, 0U);
    try {
        expect_mask(read_mat_volume(file.string(), "mask"));
    } catch (const InputError& error) {
        const std::string text = error.what();
        if (text.find("libmatio-dev") == std::string::npos) throw;
        GTEST_SKIP() << text;
    }
    EXPECT_EQ(read_mat_volume(file.string(), "open").values, (std::vector<double>{0, 1, 255}));
    EXPECT_EQ(read_mat_volume(file.string(), "number").values, (std::vector<double>{0.1}));
}

TEST(NpzVolumeTest, NamesTheArraysThatThereAre) {
    const TemporaryFolder folder;
    const auto file = write_to<write_npz>(folder / "a.npz");
    expect_parts(message_of<InputError>([&] { return read_npz_volume(file, "meas"); }),
                 {"a.npz: array \"meas\"", "is missing", "\"mask\", \"open\", \"number\""});
    expect_parts(message_of<InputError>([&] { return read_npz_volume(file, "number"); }),
                 {"array \"number\"", "dimensions"});
}

TEST(NpzVolumeTest, RefusesEveryDamagedArchive) {
    const TemporaryFolder folder;
    const std::vector<std::uint8_t> bytes = read_file(write_to<write_npz>(folder / "a.npz"));
    const auto problem = [](std::span<const std::uint8_t> content) {
        return message_of<InputError>([&] { return parse_npz_volume(content, "a.npz", "mask"); });
    };
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_NE(problem(std::span(bytes).first(length)), "") << length;
    std::vector<std::uint8_t> changed = bytes;
    constexpr std::size_t kInValues = 200;
    changed[kInValues] ^= 1U;
    expect_parts(problem(changed), {"a.npz: array \"mask\"", "wrong checksum"});
}

}  // namespace
}  // namespace stipple
