#include "study/metrics/emva1288/series.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple::emva1288 {
namespace {

constexpr auto kWhole =
    "v 4.0\n"
    "# a comment\n"
    "n 12 320 240\r\n"
    "\n"
    "d 1000000\n"
    "i images\\dark 1.png\r\n"
    "i images/dark 2.png\n"
    "b 1000000 2.5e3\n"
    "i 3.png\n"
    "i 4.png\n"
    "i 5.png";

TEST(SeriesTest, ReadsADescriptorOfTheReferenceSoftware) {
    const Series series = parse_series(kWhole, "a.txt");
    EXPECT_EQ(series.bits, 12);
    EXPECT_EQ(series.cols, 320);
    EXPECT_EQ(series.rows, 240);
    ASSERT_EQ(series.groups.size(), 2U);
    EXPECT_TRUE(series.groups[0].dark);
    EXPECT_EQ(series.groups[0].exposure_ns, 1e6);
    EXPECT_EQ(series.groups[0].files,
              (std::vector<std::string>{"images/dark 1.png", "images/dark 2.png"}));
    EXPECT_FALSE(series.groups[1].dark);
    EXPECT_EQ(series.groups[1].photons, 2500);
    EXPECT_EQ(series.groups[1].files.size(), 3U);
}

// As the documentation of the reference software says: "n bits width height", "b exposure photons"
// and "d exposure", in ns, each followed by lines "i path".
TEST(SeriesTest, WritesTheLinesOfTheReferenceSoftware) {
    const Series series{
        .bits = 10,
        .cols = 656,
        .rows = 494,
        .groups = {{.exposure_ns = 40000, .photons = 120.5, .files = {"bright/a.tif", "b.tif"}},
                   {.exposure_ns = 320000.25, .dark = true, .files = {"c.tif", "d.tif", "e.tif"}}}};
    EXPECT_EQ(series_text(series),
              "v 4.0\n"
              "n 10 656 494\n"
              "b 40000 120.5\n"
              "i bright/a.tif\n"
              "i b.tif\n"
              "d 320000.25\n"
              "i c.tif\n"
              "i d.tif\n"
              "i e.tif\n");
}

TEST(SeriesTest, ReadsEachFieldThatItWrites) {
    for (const double number : {0.0, 0.001, 0.1, 1.0 / 3, 123456789.25, 1e12}) {
        const Series written{
            .bits = 16,
            .cols = 3,
            .rows = 5,
            .groups = {{.exposure_ns = number, .dark = true, .files = {"a", "b c"}},
                       {.exposure_ns = 7, .photons = number, .files = {"d", "e"}}}};
        const Series read = parse_series(series_text(written), "a.txt");
        EXPECT_EQ(std::tuple(read.bits, read.cols, read.rows), std::tuple(16, 3, 5));
        ASSERT_EQ(read.groups.size(), 2U);
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_EQ(read.groups[i].exposure_ns, written.groups[i].exposure_ns);
            EXPECT_EQ(read.groups[i].photons, written.groups[i].photons);
            EXPECT_EQ(read.groups[i].dark, written.groups[i].dark);
            EXPECT_EQ(read.groups[i].files, written.groups[i].files);
        }
    }
}

TEST(SeriesTest, ReadsEachVersionAndAnyOrderOfTheHeader) {
    const std::string whole = kWhole;
    const std::string expected = series_text(parse_series(whole, "a.txt"));
    const std::string body = whole.substr(std::string_view("v 4.0\n").size());
    const auto same = [&](const std::string& text) {
        EXPECT_EQ(series_text(parse_series(text, "a.txt")), expected) << text;
    };
    for (const char* version : {"v 3.0\n", "v 3.1\r\n", "v 4.0\n", "v 4.1\n", ""})
        same(version + body);
    same("l camera Model X, no. 7\n" + whole);
    const std::string format = "n 12 320 240\n";
    const std::string groups = body.substr(body.find('d'));
    same(groups + "\n" + format);
    same(format + groups + "\nv 3.0\n");
    std::string commas = whole;
    same(commas.replace(commas.find("2.5e3"), 5, "2500,0"));
}

TEST(SeriesTest, NamesTheLineThatIsWrong) {
    const auto refuse = [](const std::string& text, const std::vector<std::string>& parts) {
        expect_parts(message_of<InputError>([&] { return parse_series(text, "a.txt"); }), parts);
    };
    const std::string start = "v 4.0\nn 12 320 240\n";
    refuse("", {"a.txt:0", "no line \"n bits"});
    for (const std::string version : {"", "2.9", "5.0", "nan", "4.x"})
        refuse("v " + version + "\n", {"a.txt:1", "version \"" + version + "\"", "3.x and 4.x"});
    refuse("v 4.0\n", {"no line \"n bits width height\""});
    refuse("v 4.0\nn 17 320 240\n", {"a.txt:2", "bits 17 is outside 1..16"});
    refuse("v 4.0\nn 12 320\n", {"a.txt:2", "height is missing"});
    refuse("v 4.0\nn 12 3.5 240\n", {"width is not a whole number"});
    refuse("v 4.0\nn 12 320 240 1\n", {"a.txt:2", "more than the line needs"});
    refuse(start + "n 8 2 2\n", {"a.txt:3", "a second line n"});
    refuse(start, {"names no images"});
    refuse("v 4.0\nb 1 1\ni a.png\ni b.png\n", {"a.txt:4", "no line \"n bits width height\""});
    refuse(start + "i a.png\n", {"a.txt:3", "before the first line"});
    refuse(start + "b 10\n", {"a.txt:3", "photons is missing"});
    refuse(start + "b 10 x\n", {"photons \"x\" is not a number"});
    refuse(start + "b 10 nan\n", {"photons nan is outside"});
    refuse(start + "d -1\n", {"exposure in ns -1 is outside"});
    refuse(start + "d 1\ni a.png\nd 1\n", {"a.txt:5", "fewer than the two"});
    refuse(start + "d 1\ni a.png\n", {"fewer than the two"});
    refuse(start + "d 1\ni\n", {"a.txt:4", "the name of the image is missing"});
    refuse(start + "dc 1e6\n", {"a.txt:3", "dark-current images (dc) are not evaluated"});
    refuse(start + "x 1\n", {"a.txt:3", "\"x\" is none of v, n, b, d, i"});
}

}  // namespace
}  // namespace stipple::emva1288
