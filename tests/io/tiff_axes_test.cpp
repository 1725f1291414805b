#include "io/tiff_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace stipple {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Pages of 32 x 48 grey pixels.
TiffTimes times_of(std::string_view text, std::uint64_t pages, std::uint64_t channels = 1) {
    return times_of_pages(text, {pages, channels, channels * 32 * 48}, "a.tif");
}

std::string refusal_of(std::string_view text, std::uint64_t pages, std::uint64_t channels = 1) {
    try {
        static_cast<void>(times_of(text, pages, channels));
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

std::string ome(std::string_view sizes, std::string_view prefix = "") {
    return fmt::format(
        R"(<?xml version="1.0"?><{0}OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06">)"
        R"(<{0}Image ID="Image:0"><{0}Pixels ID="Pixels:0" SizeX="48" SizeY="32" {1}>)"
        R"(<{0}TiffData/></{0}Pixels></{0}Image></{0}OME>)",
        prefix, sizes);
}

TEST(TiffAxesTest, RefusesChannelsAndFocalPlanes) {
    EXPECT_THAT(refusal_of("ImageJ=1.11a\nimages=8\nchannels=2\nframes=4\nhyperstack=true\n", 8),
                HasSubstr("a.tif: declares 2 channels for its 8 pages"));
    EXPECT_THAT(refusal_of("ImageJ=1.54f\nimages=8\nslices=2\nframes=4\nhyperstack=true\n", 8),
                HasSubstr("2 slices"));
    EXPECT_THAT(refusal_of("ImageJ=1.54f\nimages=8\nslices=8\nhyperstack=true\n", 8),
                HasSubstr("8 slices"));
    for (const char* const prefix : {"", "OME:"}) {
        EXPECT_THAT(refusal_of(ome(R"(SizeZ="1" SizeC="2" SizeT="4")", prefix), 8),
                    HasSubstr("2 channels (SizeC)"));
        EXPECT_THAT(refusal_of(ome(R"(SizeZ="8" SizeC="1" SizeT="1")", prefix), 8),
                    HasSubstr("8 focal planes (SizeZ)"));
    }
    EXPECT_THAT(refusal_of(ome(R"(SizeZ="1" SizeC="6" SizeT="4")"), 8, 3), HasSubstr("2 channels"));
    const std::string image = ome(R"(SizeZ="1" SizeC="1" SizeT="4")");
    EXPECT_THAT(refusal_of(image + image, 8), HasSubstr("several images"));
    EXPECT_THAT(refusal_of(R"({"axes": "TCYX", "shape": [4, 2, 32, 48]})", 8),
                HasSubstr("the axes TCYX of 4, 2, 32, 48"));
    EXPECT_THAT(refusal_of(R"({"shape": [8, 32, 48], "axes": "ZYX"})", 8), HasSubstr("axes ZYX"));
    EXPECT_THAT(refusal_of(R"({"shape": [4, 2, 32, 48]})", 8), HasSubstr("an array of 4, 2, 32"));
}

TEST(TiffAxesTest, TakesPagesThatAreMoments) {
    for (const std::string& text :
         {std::string("ImageJ=1.11a\nimages=4\nframes=4\nhyperstack=true\nmode=grayscale\n"),
          ome(R"(SizeZ="1" SizeC="1" SizeT="4")"), std::string(R"({"shape": [4, 32, 48]})"),
          std::string(R"({"shape": [4, 1, 32, 48], "axes": "TCYX"})"),
          std::string(R"({"shape": [32, 48]})"), std::string(R"({"shape": [5, 7]})"),
          std::string(R"({"shape": []})"), std::string(R"({"shape": [0, 32, 48]})"),
          std::string("ImageJ="), std::string("a camera"), std::string()})
        EXPECT_THAT(times_of(text, 4).warnings, IsEmpty()) << text;
    EXPECT_THAT(times_of(ome(R"(SizeZ="1" SizeC="3" SizeT="4")"), 4, 3).warnings, IsEmpty());
    EXPECT_THAT(times_of(R"({"shape": [4, 3, 32, 48]})", 4, 3).warnings, IsEmpty());
    EXPECT_THAT(times_of(R"({"shape": [4, 32, 48, 3]})", 4, 3).warnings, IsEmpty());
}

TEST(TiffAxesTest, TakesMoreChannelsThanImageJShowsForMomentsWithAWarning) {
    EXPECT_THAT(refusal_of("ImageJ=1.11a\nimages=7\nchannels=7\nhyperstack=true\n", 7),
                HasSubstr("7 channels"));
    EXPECT_THAT(
        times_of("ImageJ=1.11a\nimages=8\nchannels=8\nhyperstack=true\n", 8).warnings.at(0).text(),
        HasSubstr("8 channels"));
}

TEST(TiffAxesTest, WarnsOfAPlainStackOfImageJAndOfMomentsInOtherFiles) {
    EXPECT_THAT(times_of("ImageJ=1.54f\nimages=4\nslices=4\nloop=false\n", 4).warnings.at(0).text(),
                HasSubstr("declares 4 slices"));
    EXPECT_THAT(times_of(ome(R"(SizeZ="1" SizeC="1" SizeT="100")"), 4).warnings.at(0).text(),
                HasSubstr("declares 100 moments in time (SizeT), but holds 4 pages"));
}

TEST(TiffAxesTest, RefusesFewerPagesThanAnnounced) {
    EXPECT_THAT(refusal_of("ImageJ=1.54f\nimages=9\nframes=9\n", 1),
                HasSubstr("announces 9 image"));
    EXPECT_THAT(refusal_of(R"({"truncated": true, "shape": [9, 32, 48]})", 1),
                HasSubstr("announces an array of 9, 32, 48, but its directories hold 1 pages"));
    EXPECT_THAT(refusal_of(R"({"shape": [18446744073709551615, 18446744073709551615, 32, 48]})", 4),
                HasSubstr("announces"));
}

TEST(TiffAxesTest, RateIsThatOfTheIntervalInItsUnit) {
    const auto rate = [](std::string_view text) { return times_of(text, 4).frames_hz; };
    EXPECT_EQ(rate("ImageJ=1.54f\nimages=4\nframes=4\nfinterval=0.125\n"), 8);
    EXPECT_EQ(rate("ImageJ=1.54f\nimages=4\nframes=4\ntunit=ms\nfinterval=0.125\n"), 8000);
    const std::string sizes = R"(SizeZ="1" SizeC="1" SizeT="4" TimeIncrement=")";
    EXPECT_EQ(rate(ome(sizes + R"(0.5")")), 2);
    EXPECT_EQ(rate(ome(sizes + R"(0.5" TimeIncrementUnit="ms")")), 2000);
    EXPECT_DOUBLE_EQ(*rate(ome(sizes + "0.5\" TimeIncrementUnit=\"\xC2\xB5s\"")), 2e6);
    for (const char* const none : {R"(0")", R"(-1")", R"(nan")", R"(inf")", R"(1e-300")", R"(")",
                                   R"(2" TimeIncrementUnit="frames")"})
        EXPECT_EQ(rate(ome(sizes + none)), std::nullopt) << none;
}

}  // namespace
}  // namespace stipple
