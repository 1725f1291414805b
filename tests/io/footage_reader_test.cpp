#include "io/footage_reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>

#include "tests/io/npy_bytes.h"
#include "tests/io/test_images.h"
#include "tests/support/footage_folder.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Floats = std::vector<float>;

Floats read_npy(const TemporaryFolder& folder, const std::string& file,
                FootageOptions options = {}) {
    write_text(folder / "clip.npy", file);
    return read_all(folder / "clip.npy", options);
}

TEST(FootageReaderTest, ReadsEveryNpyTypeInLinearLight) {
    const TemporaryFolder folder;
    const auto u1 = bytes_of(std::vector<std::uint8_t>{0, 51, 255});
    const auto u2 = bytes_of(std::vector<std::uint16_t>{0, 13107, 65535});
    const auto f2 = bytes_of(std::vector<std::uint16_t>{0x0000, 0x3800, 0x4200});  // IEEE binary16
    const auto f4 = bytes_of(std::vector<float>{0.0F, 0.125F, 7.5F});
    const auto f8 = bytes_of(std::vector<double>{0.0, 0.1, 1e-60});
    EXPECT_EQ(read_npy(folder, npy_file("|u1", "(1, 1, 3)", u1)), (Floats{0, 0.2F, 1}));
    EXPECT_EQ(read_npy(folder, npy_file("<u2", "(1, 3, 1)", u2)), (Floats{0, 0.2F, 1}));
    EXPECT_EQ(read_npy(folder, npy_file("<f2", "(3, 1, 1)", f2)), (Floats{0, 0.5F, 3}));
    EXPECT_EQ(read_npy(folder, npy_file("<f4", "(1, 1, 3)", f4)), (Floats{0, 0.125F, 7.5F}));
    EXPECT_EQ(read_npy(folder, npy_file("<f8", "(1, 1, 3)", f8)), (Floats{0, 0.1F, 0}));
}

TEST(FootageReaderTest, TurnsInterleavedColourIntoPlanes) {
    const TemporaryFolder folder;
    const auto rgb = bytes_of(Floats{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    EXPECT_EQ(read_npy(folder, npy_file("<f4", "(2, 1, 2, 3)", rgb)),
              (Floats{1, 4, 2, 5, 3, 6, 7, 10, 8, 11, 9, 12}));
}

TEST(FootageReaderTest, TellsShapeAndSlots) {
    const TemporaryFolder folder;
    write_text(folder / "clip.npy", npy_file("|u1", "(4, 2, 3, 3)", std::string(72, '\0')));
    const FootageReader colour(folder / "clip.npy");
    EXPECT_EQ(colour.shape(), (FrameShape{2, 3, 3}));
    EXPECT_EQ(colour.slots(), 4);
    const FootageReader grey(folder / "clip.npy", {.luminance = true, .max_value = {}});
    EXPECT_EQ(grey.shape(), (FrameShape{2, 3, 1}));
}

TEST(FootageReaderTest, ReadsPngAndTiffOf8And16Bit) {
    for (const char* name : {"f.png", "f.tiff", "f.TIF"}) {
        const TemporaryFolder folder;
        const auto read = [&](int type, cv::Scalar colour) {
            write_flat(folder / name, 1, 1, type, colour);
            return read_all(folder.path());
        };
        EXPECT_EQ(read(CV_8UC1, {51}), Floats{0.2F}) << name;
        EXPECT_EQ(read(CV_16UC1, {13107}), Floats{0.2F}) << name;
        EXPECT_EQ(read(CV_8UC3, {51, 102, 255}), (Floats{1, 0.4F, 0.2F})) << name;
        EXPECT_EQ(read(CV_16UC3, {13107, 26214, 65535}), (Floats{1, 0.4F, 0.2F})) << name;
        EXPECT_EQ(read(CV_8UC4, {51, 102, 255, 9}), (Floats{1, 0.4F, 0.2F})) << name;
        EXPECT_EQ(read(CV_16UC4, {13107, 26214, 65535, 9}), (Floats{1, 0.4F, 0.2F})) << name;
    }
}

TEST(FootageReaderTest, ReadsFoldersAndPatternsInNumericOrder) {
    const TemporaryFolder folder;
    for (const int i : {10, 9, 11})
        write_flat(folder / fmt::format("f{}.png", i), 1, 1, CV_8UC1, i * 5);
    write_text(folder / "meta.json", "{}");
    const Floats expected = {45 / 255.0F, 50 / 255.0F, 55 / 255.0F};
    EXPECT_EQ(read_all(folder.path()), expected);
    EXPECT_EQ(read_all(folder / "f%d.png"), expected);
    EXPECT_EQ(read_all(folder / "f10.png"), Floats{50 / 255.0F});
    EXPECT_EQ(FootageReader(folder.path()).slots(), 3);
}

TEST(FootageReaderTest, UndoesTheTransferFunction) {
    const TemporaryFolder folder;
    const auto file = npy_file("<f8", "(1, 1, 4)", bytes_of(std::vector<double>{0, 0.04, 0.5, 1}));
    const auto gamma = read_npy(folder, file, {.transfer = Transfer::kGamma22, .max_value = {}});
    const auto srgb = read_npy(folder, file, {.transfer = Transfer::kSrgb, .max_value = {}});
    // 0.5^2.2; IEC 61966-2-1: 0.04 / 12.92 and ((0.5 + 0.055) / 1.055)^2.4. powf is good to a few
    // units of the last place, 1e-6 relative.
    EXPECT_EQ(gamma[0], 0.0F);
    EXPECT_NEAR(gamma[2], 0.217637640824031, 3e-7);
    EXPECT_EQ(gamma[3], 1.0F);
    EXPECT_NEAR(srgb[1], 0.00309597523219814, 3e-9);
    EXPECT_NEAR(srgb[2], 0.214041140482233, 3e-7);
    EXPECT_NEAR(srgb[3], 1.0, 1e-6);
}

TEST(FootageReaderTest, ReducesToRec709LuminanceAfterTheTransferFunction) {
    const TemporaryFolder folder;
    const auto file = npy_file("<f4", "(1, 1, 1, 3)", bytes_of(Floats{0.5F, 1, 2}));
    const double linear = 0.2126 * 0.5 + 0.7152 + 0.0722 * 2;
    const double gamma = 0.2126 * std::pow(0.5, 2.2) + 0.7152 + 0.0722 * std::pow(2, 2.2);
    const auto light = read_npy(folder, file, {.luminance = true, .max_value = {}});
    ASSERT_EQ(light.size(), 1U);
    EXPECT_NEAR(light[0], linear, 2e-7);  // some roundings of 2^-24
    EXPECT_NEAR(read_npy(folder, file, {Transfer::kGamma22, true, {}})[0], gamma, 2e-6);
    const auto mono = npy_file("<f4", "(1, 1, 1)", bytes_of(Floats{0.5F}));
    EXPECT_EQ(read_npy(folder, mono, {.luminance = true, .max_value = {}}), Floats{0.5F});
}

TEST(FootageReaderTest, ClipsAtTheLargestValueAfterTheReductionToLuminance) {
    const TemporaryFolder folder;
    const auto mono = npy_file("<f4", "(1, 1, 3)", bytes_of(Floats{1.5F, 2, 900}));
    EXPECT_EQ(read_npy(folder, mono, {.max_value = 2.0}), (Floats{1.5F, 2, 2}));
    const auto blue = npy_file("<f4", "(1, 1, 1, 3)", bytes_of(Floats{0, 0, 10}));
    EXPECT_NEAR(read_npy(folder, blue, {.luminance = true, .max_value = 2.0})[0], 0.722, 1e-6);
}

TEST(FootageReaderTest, ClipsNegativeLightAfterTheReductionToAPart) {
    const TemporaryFolder folder;
    const auto mono = npy_file("<f4", "(1, 2, 2)", bytes_of(Floats{-0.5F, 1.5F, -6e-8F, -0.25F}));
    const auto read = [&](double min, FootagePart part = {}) {
        return read_npy(folder, mono, {.max_value = 1.0, .min_value = min, .part = part});
    };
    EXPECT_EQ(read(0), (Floats{0, 1, 0, 0}));
    EXPECT_EQ(read(0.25), (Floats{0.25F, 1, 0.25F, 0.25F}));
    EXPECT_NEAR(read(0, {.bin = 2})[0], 0.75 / 4, 1e-7);
    EXPECT_THROW(read(1.5), InputError);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity})
        EXPECT_THROW(read_npy(folder, npy_file("<f4", "(1, 1, 1)", bytes_of(Floats{bad})),
                              {.max_value = {}, .min_value = 0.0}),
                     InputError);
}

TEST(FootageReaderTest, KeepsReturningFalseAtTheEnd) {
    const TemporaryFolder folder;
    write_text(folder / "clip.npy", npy_file("|u1", "(1, 1, 1)", "a"));
    FootageReader reader(folder / "clip.npy");
    Floats frame(1);
    EXPECT_TRUE(reader.read(frame));
    EXPECT_FALSE(reader.read(frame));
    EXPECT_FALSE(reader.read(frame));
}

/// The frames from `first` on; the first is read before the others are skipped.
Floats read_from(const fs::path& source, int first, const FootageOptions& options) {
    FootageReader reader(source, options);
    Floats all, frame(reader.shape().sites());
    EXPECT_TRUE(reader.read(frame));
    reader.skip(first - 1);
    while (reader.read(frame)) all.insert(all.end(), frame.begin(), frame.end());
    return all;
}

TEST(FootageReaderTest, FramesThatAreSkippedAreLeftOut) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "images");
    for (int i = 0; i < 5; ++i)
        write_flat(folder / fmt::format("images/f{}.png", i), 1, 2, CV_8UC1, i * 5);
    write_text(folder / "clip.npy", npy_file("|u1", "(5, 1, 2)", "aabbccddee"));
    write_text(folder / "clip.raw", "aabbccddee");
    FootageOptions raw;
    raw.raw = parse_raw_format("2x1:mono8");
    for (const auto& [name, options] :
         {std::pair("images", FootageOptions()), {"clip.npy", FootageOptions()}, {"clip.raw", raw}})
        for (int first = 1; first < 8; ++first) {
            SCOPED_TRACE(fmt::format("{} from frame {}", name, first));
            Floats rest = read_all(folder / name, options);
            rest.erase(rest.begin(), rest.begin() + 2 * std::min(first, 5));
            EXPECT_EQ(read_from(folder / name, first, options), rest);
        }
}

/// A number of a clip's meta.json.
int described(const fs::path& clip, const std::string& key) {
    const std::string text = read_text(clip / "meta.json");
    return std::stoi(text.substr(text.find('"' + key + "\":") + key.size() + 3));
}

TEST(FootageReaderTest, ReadsRealClipsAsTheyAreDescribed) {
    const auto footage = footage_clip("");
    if (!footage) GTEST_SKIP() << "no footage in " << footage_folder();
    int clips = 0;
    for (const auto& entry : fs::directory_iterator(*footage)) {
        if (!entry.is_directory()) continue;
        SCOPED_TRACE(entry.path());
        FootageReader reader(entry.path());
        EXPECT_EQ(reader.shape(),
                  (FrameShape{described(entry.path(), "height"), described(entry.path(), "width"),
                              described(entry.path(), "channels")}));
        Floats frame(reader.shape().sites());
        int slots = 0;
        while (reader.read(frame)) ++slots;
        EXPECT_EQ(reader.slots(), slots);
        EXPECT_EQ(slots, described(entry.path(), "frames"));
        EXPECT_GT(*std::max_element(frame.begin(), frame.end()), 0.05F);
        ++clips;
    }
    EXPECT_GT(clips, 0) << "no clips in " << *footage;
}

/// Sets STIPPLE_FOOTAGE, or takes it away, while it lives.
class FootageSetting {
  public:
    explicit FootageSetting(const char* folder) {
        if (const char* const before = std::getenv(kName)) before_ = before;
        set(folder);
    }
    ~FootageSetting() { set(before_ ? before_->c_str() : nullptr); }
    FootageSetting(const FootageSetting&) = delete;
    FootageSetting& operator=(const FootageSetting&) = delete;

  private:
    static constexpr const char* kName = "STIPPLE_FOOTAGE";
    static void set(const char* folder) {
        if (folder != nullptr)
            setenv(kName, folder, 1);
        else
            unsetenv(kName);
    }
    std::optional<std::string> before_;
};

TEST(FootageFolderTest, AClipThatIsMissingWhereTheSettingSaysIsAnError) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "clip");
    const FootageSetting setting(folder.path().c_str());
    EXPECT_EQ(footage_clip("clip"), folder / "clip");
    expect_parts(message_of<std::runtime_error>([] { return footage_clip("renamed"); }),
                 {(folder / "renamed").string(), "STIPPLE_FOOTAGE"});
}

TEST(FootageFolderTest, WithoutTheSettingAMissingClipIsNone) {
    const FootageSetting none(nullptr);
    EXPECT_EQ(footage_clip("no such clip"), std::nullopt);
}

}  // namespace
}  // namespace stipple
