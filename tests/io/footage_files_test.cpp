#include "io/footage_files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

Names names_of(const ImageFiles& images) {
    Names names;
    for (const auto& file : images.files) names.push_back(file.filename().string());
    return names;
}

TEST(FootageFilesTest, OrdersDigitsAsNumbers) {
    const Names ordered = {"",
                           "a",
                           "a0",
                           "a00",
                           "a01",
                           "a1",
                           "a2b1",
                           "a2b10",
                           "a10",
                           "b",
                           "b99999999999999999999998",
                           "b99999999999999999999999"};
    for (std::size_t i = 0; i < ordered.size(); ++i)
        for (std::size_t j = 0; j < ordered.size(); ++j)
            EXPECT_EQ(numerically_before(ordered[i], ordered[j]), i < j)
                << ordered[i] << " and " << ordered[j];
}

TEST(FootageFilesTest, ListsImagesInNumericOrderAndNothingElse) {
    const TemporaryFolder folder;
    for (const char* name : {"f10.png", "f9.PNG", "f100.png", "meta.json", "._f1.png", "notes"})
        write_text(folder / name, "");
    EXPECT_EQ(names_of(images_in_folder(folder.path())), (Names{"f9.PNG", "f10.png", "f100.png"}));
}

TEST(FootageFilesTest, RefusesMixedFormats) {
    const TemporaryFolder folder;
    write_text(folder / "f1.png", "");
    write_text(folder / "f2.exr", "");
    expect_parts(message_of<InputError>([&] { return images_in_folder(folder.path()); }),
                 {folder.path().string() + ": mixes formats: \"f1.png\" and \"f2.exr\""});
    const TemporaryFolder tiffs;  // two spellings of one format
    write_text(tiffs / "f1.tif", "");
    write_text(tiffs / "f2.tiff", "");
    EXPECT_EQ(images_in_folder(tiffs.path()).files.size(), 2U);
}

TEST(FootageFilesTest, RefusesAFolderWithoutImages) {
    const TemporaryFolder folder;
    write_text(folder / "f1.jpg", "");
    expect_parts(message_of<InputError>([&] { return images_in_folder(folder.path()); }),
                 {"holds no PNG, TIFF, EXR or DNG"});
}

TEST(FootageFilesTest, FindsTheImagesOfAPattern) {
    const TemporaryFolder folder;
    for (const char* name : {"f_0098.png", "f_0099.png", "f_0100.png", "f_101.png", "f_00101.png",
                             "f_0101.png.bak", "g_0101.png", "f_-099.png", "f_.png"})
        write_text(folder / name, "");
    EXPECT_EQ(names_of(images_of_pattern(folder / "f_%04d.png")),
              (Names{"f_0098.png", "f_0099.png", "f_0100.png"}));
    EXPECT_EQ(names_of(images_of_pattern(folder / "f_%d.png")), Names{"f_101.png"});
}

TEST(FootageFilesTest, NamesTheMissingImageOfAPattern) {
    const TemporaryFolder folder;
    for (const char* name : {"f1.png", "f2.png", "f4.png", "f6.png"}) write_text(folder / name, "");
    expect_parts(message_of<InputError>([&] { return images_of_pattern(folder / "f%d.png"); }),
                 {"/f3.png: is missing from the sequence"});
}

/// The warning about a folder of these images, without the folder's name.
std::string warning_of(const Names& names) {
    const TemporaryFolder folder;
    for (const std::string& name : names) write_text(folder / name, "");
    const std::string warning = images_in_folder(folder.path()).warning;
    const std::string where = folder.path().string() + "/";
    return warning.starts_with(where) ? warning.substr(where.size()) : warning;
}

TEST(FootageFilesTest, NamesTheNumbersThatAFolderSkips) {
    EXPECT_EQ(warning_of({"f000.png", "f001.png", "f002.png", "f004.png", "f005.png"}),
              "f003.png is missing: the frames after it move one slot forward");
    EXPECT_EQ(warning_of({"f7.png", "f8.png", "f9.png", "f12.png", "f14.png"}),
              "f10.png and 2 more are missing: the frames after them move forward, 3 slots in all");
    EXPECT_EQ(warning_of({"f07.png", "f08.png", "f10.png"}),
              "f09.png is missing: the frames after it move one slot forward");
    EXPECT_EQ(warning_of({"f008_b2.png", "f009_b2.png", "f011_b2.png"}),
              "f010_b2.png is missing: the frames after it move one slot forward");
}

TEST(FootageFilesTest, TakesAFolderWithoutSkippedNumbersInSilence) {
    EXPECT_EQ(warning_of({"f9.png", "f10.png", "f11.png"}), "");
    EXPECT_EQ(warning_of({"f0.png", "f2.png", "f4.png"}), "");           // every second one
    EXPECT_EQ(warning_of({"t1623.png", "t1656.png", "t1690.png"}), "");  // times
    EXPECT_EQ(warning_of({"t100.png", "t101.png", "t203.png", "t301.png"}), "");
    EXPECT_EQ(warning_of({"a1.png", "a2.png", "b7.png", "b8.png"}), "");
    EXPECT_EQ(warning_of({"1.png"}), "");
    EXPECT_EQ(warning_of({"one.png", "two.png"}), "");
    EXPECT_EQ(warning_of({"f99999999999999999998.png", "f99999999999999999999.png"}), "");
}

TEST(FootageFilesTest, SaysWhichNumbersAPatternLeavesOut) {
    const TemporaryFolder folder;
    for (int i = 7; i <= 12; ++i) write_text(folder / fmt::format("f{}.png", i), "");
    expect_parts(images_of_pattern(folder / "f%02d.png").warning,
                 {"f%02d.png: takes f10.png to f12.png; left out are 3 images of other digits: "
                  "f7.png"});
    EXPECT_EQ(images_of_pattern(folder / "f%d.png").warning, "");
}

TEST(FootageFilesTest, RefusesMalformedPatternsAndEmptyMatches) {
    const TemporaryFolder folder;
    for (const char* name : {"f%s.png", "f%.png", "f%d%d.png", "f%4d.png", "f%004d.png",
                             "f%012d.png", "f%0d.png", "f%x.png", "%", "f%04", "f%n.png"})
        expect_parts(message_of<InputError>([&] { return images_of_pattern(folder / name); }),
                     {std::string(name) + ": a pattern needs one %d or %0Nd"});
    expect_parts(message_of<InputError>([&] { return images_of_pattern(folder / "f%d.jpg"); }),
                 {"stands for PNG, TIFF, EXR or DNG"});
    expect_parts(message_of<InputError>([&] { return images_of_pattern(folder / "f%d.png"); }),
                 {"no file matches"});
    expect_parts(message_of<InputError>([&] { return images_of_pattern(folder / "no/f%d.png"); }),
                 {"cannot be listed"});
}

}  // namespace
}  // namespace stipple
