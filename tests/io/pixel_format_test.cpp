#include "io/pixel_format.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <set>

#include "core/philox.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Samples = std::vector<std::uint16_t>;

Samples unpacked(const char* name, const Bytes& row, std::size_t count) {
    Samples samples(count);
    unpack_row(*pixel_format_named(name), row, samples);
    return samples;
}

/// Where bit `bit` of sample `i` lies in a row, in bits from its start: the layouts as the PFNC
/// standard, the GigE Vision standard and the kernel's documentation of V4L2 draw them.
std::size_t bit_position(const PixelFormat& format, std::size_t i, std::size_t bit) {
    const auto bits = static_cast<std::size_t>(format.significant_bits);
    const std::size_t low = bits - 8;
    switch (format.packing) {
        case Packing::kBytes:
            return i * (bits == 8 ? 8 : 16) + bit;
        case Packing::kBytesBigEndian:
            return i * 16 + (bit < 8 ? bit + 8 : bit - 8);
        case Packing::kLsbPacked:
            return i * bits + bit;
        case Packing::kMsbPacked: {
            const std::size_t from_start = i * bits + bits - 1 - bit;
            return from_start / 8 * 8 + 7 - from_start % 8;
        }
        case Packing::kGigEVisionPacked:
            if (bit < low) return i / 2 * 24 + 8 + i % 2 * 4 + bit;
            return i / 2 * 24 + i % 2 * 16 + bit - low;
        case Packing::kMipiPacked: {
            const std::size_t n = bits == 12 ? 2 : 4;
            const std::size_t start = i / n * n * bits;
            if (bit < low) return start + 8 * n + i % n * low + bit;
            return start + i % n * 8 + bit - low;
        }
    }
    return 0;
}

Bytes random_row(std::size_t count) {
    Bytes row(count);
    for (std::size_t i = 0; i < count; ++i)
        row[i] = static_cast<std::uint8_t>(
            philox4x32({static_cast<std::uint32_t>(i), 0, 0, 0}, 9)[0] >> 24U);
    return row;
}

/// Bits of a 16-bit sample that are read: all, for what is not packed has 16.
std::size_t read_bits(const PixelFormat& format) {
    const bool words =
        format.packing == Packing::kBytes || format.packing == Packing::kBytesBigEndian;
    if (words && format.significant_bits > 8) return 16;
    return static_cast<std::size_t>(format.significant_bits);
}

std::vector<PixelFormat> all_layouts() {
    std::vector<PixelFormat> all(pixel_formats().begin(), pixel_formats().end());
    for (const int bits : {9, 10, 12, 14, 16})
        all.push_back({.name = "most significant bit first",
                       .bits_per_pixel = bits,
                       .significant_bits = bits,
                       .packing = Packing::kMsbPacked});
    return all;
}

TEST(PixelFormatTest, EveryFormatUnpacksAsItsBitLayoutSaysAtAnyWidth) {
    for (const PixelFormat& format : all_layouts())
        for (int width = 1; width <= 33; ++width) {
            const Bytes row = random_row(format.row_bytes(width));
            Samples samples(static_cast<std::size_t>(width * format.planes));
            unpack_row(format, row, samples);
            for (std::size_t i = 0; i < samples.size(); ++i) {
                unsigned expected = 0;
                for (std::size_t bit = 0; bit < read_bits(format); ++bit) {
                    const std::size_t at = bit_position(format, i, bit);
                    ASSERT_LT(at / 8, row.size()) << format.name;
                    expected |= (unsigned{row[at / 8]} >> at % 8 & 1U) << bit;
                }
                ASSERT_EQ(samples[i], expected) << format.name << " width " << width << " at " << i;
            }
        }
}

// Worked out on paper: 0x123, 0x456 (12 bit); 1, 1023, 512, 0x155 (10 bit); 0x1234, 0x3FFF, 1,
// 0x2000 (14 bit).
TEST(PixelFormatTest, HandPackedRowsComeOutAsWritten) {
    const Samples twelve{0x123, 0x456};
    const Samples ten{1, 1023, 512, 0x155};
    EXPECT_EQ(unpacked("Mono8", {7, 255}, 2), (Samples{7, 255}));
    EXPECT_EQ(unpacked("Mono16", {0x34, 0x12}, 1), (Samples{0x1234}));
    EXPECT_EQ(unpacked("Mono16BE", {0x12, 0x34}, 1), (Samples{0x1234}));
    EXPECT_EQ(unpacked("Mono12", {0x23, 0x01, 0x56, 0x04}, 2), twelve);
    EXPECT_EQ(unpacked("Mono12p", {0x23, 0x61, 0x45}, 2), twelve);
    EXPECT_EQ(unpacked("Mono12Packed", {0x12, 0x63, 0x45}, 2), twelve);
    EXPECT_EQ(unpacked("BayerGB12MIPI", {0x12, 0x45, 0x63}, 2), twelve);
    EXPECT_EQ(unpacked("Mono10p", {0x01, 0xFC, 0x0F, 0x60, 0x55}, 4), ten);
    EXPECT_EQ(unpacked("Mono10Packed", {0x00, 0x31, 0xFF, 0x80, 0x10, 0x55}, 4), ten);
    EXPECT_EQ(unpacked("Mono10MIPI", {0x00, 0xFF, 0x80, 0x55, 0x4D}, 4), ten);
    EXPECT_EQ(unpacked("BayerRG14MIPI", {0x48, 0xFF, 0x00, 0x80, 0xF4, 0x1F, 0x00}, 4),
              (Samples{0x1234, 0x3FFF, 1, 0x2000}));
    EXPECT_EQ(unpacked("RGB8", {1, 2, 3, 4, 5, 6}, 6), (Samples{1, 2, 3, 4, 5, 6}));
}

TEST(PixelFormatTest, NamesAndCodesAreUniqueAndFoundAgain) {
    std::set<std::string_view> names;
    std::set<std::uint32_t> codes;
    for (const PixelFormat& format : pixel_formats()) {
        EXPECT_TRUE(names.insert(format.name).second) << format.name;
        EXPECT_EQ(pixel_format_named(format.name), &format);
        if (format.pfnc != 0) {
            EXPECT_TRUE(codes.insert(format.pfnc).second) << format.name;
            EXPECT_EQ(pixel_format_of_pfnc(format.pfnc), &format);
            // Bits 16 to 23 of a PFNC code are the bits of a pixel.
            EXPECT_EQ(static_cast<int>(format.pfnc >> 16U & 0xFFU), format.bits_per_pixel)
                << format.name;
        }
        if (format.v4l2 != 0) {
            EXPECT_TRUE(codes.insert(format.v4l2).second) << format.name;
            EXPECT_EQ(pixel_format_of_v4l2(format.v4l2), &format);
        }
        EXPECT_TRUE(format.pfnc != 0 || format.v4l2 != 0) << format.name;
    }
    EXPECT_EQ(pixel_format_of_pfnc(0), nullptr);
    EXPECT_EQ(pixel_format_of_v4l2(0), nullptr);
    EXPECT_EQ(pixel_format_named("YUV422_8"), nullptr);
}

TEST(PixelFormatTest, CodesOfV4l2AreThoseOfTheKernel) {
    const std::pair<const char*, std::uint32_t> expected[] = {
        {"Mono8", V4L2_PIX_FMT_GREY},
        {"Mono10", V4L2_PIX_FMT_Y10},
        {"Mono12", V4L2_PIX_FMT_Y12},
        {"Mono14", V4L2_PIX_FMT_Y14},
        {"Mono16", V4L2_PIX_FMT_Y16},
        {"Mono16BE", V4L2_PIX_FMT_Y16_BE},
        {"Mono10MIPI", V4L2_PIX_FMT_Y10P},
        {"RGB8", V4L2_PIX_FMT_RGB24},
        {"BayerRG8", V4L2_PIX_FMT_SRGGB8},
        {"BayerGR8", V4L2_PIX_FMT_SGRBG8},
        {"BayerGB8", V4L2_PIX_FMT_SGBRG8},
        {"BayerBG8", V4L2_PIX_FMT_SBGGR8},
        {"BayerRG10", V4L2_PIX_FMT_SRGGB10},
        {"BayerGR10", V4L2_PIX_FMT_SGRBG10},
        {"BayerGB10", V4L2_PIX_FMT_SGBRG10},
        {"BayerBG10", V4L2_PIX_FMT_SBGGR10},
        {"BayerRG12", V4L2_PIX_FMT_SRGGB12},
        {"BayerGR12", V4L2_PIX_FMT_SGRBG12},
        {"BayerGB12", V4L2_PIX_FMT_SGBRG12},
        {"BayerBG12", V4L2_PIX_FMT_SBGGR12},
        {"BayerRG14", V4L2_PIX_FMT_SRGGB14},
        {"BayerGR14", V4L2_PIX_FMT_SGRBG14},
        {"BayerGB14", V4L2_PIX_FMT_SGBRG14},
        {"BayerBG14", V4L2_PIX_FMT_SBGGR14},
        {"BayerRG16", V4L2_PIX_FMT_SRGGB16},
        {"BayerGR16", V4L2_PIX_FMT_SGRBG16},
        {"BayerGB16", V4L2_PIX_FMT_SGBRG16},
        {"BayerBG16", V4L2_PIX_FMT_SBGGR16},
        {"BayerRG10MIPI", V4L2_PIX_FMT_SRGGB10P},
        {"BayerGR10MIPI", V4L2_PIX_FMT_SGRBG10P},
        {"BayerGB10MIPI", V4L2_PIX_FMT_SGBRG10P},
        {"BayerBG10MIPI", V4L2_PIX_FMT_SBGGR10P},
        {"BayerRG12MIPI", V4L2_PIX_FMT_SRGGB12P},
        {"BayerGR12MIPI", V4L2_PIX_FMT_SGRBG12P},
        {"BayerGB12MIPI", V4L2_PIX_FMT_SGBRG12P},
        {"BayerBG12MIPI", V4L2_PIX_FMT_SBGGR12P},
        {"BayerRG14MIPI", V4L2_PIX_FMT_SRGGB14P},
        {"BayerGR14MIPI", V4L2_PIX_FMT_SGRBG14P},
        {"BayerGB14MIPI", V4L2_PIX_FMT_SGBRG14P},
        {"BayerBG14MIPI", V4L2_PIX_FMT_SBGGR14P},
    };
    std::size_t coded = 0;
    for (const PixelFormat& format : pixel_formats()) coded += format.v4l2 != 0 ? 1 : 0;
    EXPECT_EQ(coded, std::size(expected));
    for (const auto& [name, code] : expected) {
        ASSERT_NE(pixel_format_named(name), nullptr) << name;
        EXPECT_EQ(pixel_format_named(name)->v4l2, code) << name;
    }
}

}  // namespace
}  // namespace stipple
