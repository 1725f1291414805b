#include "io/tiff_file.h"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstdint>

#include "core/error.h"
#include "io/image_file.h"
#include "tests/io/test_images.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

struct Layout {
    std::uint32_t rows = 3;
    std::uint32_t cols = 5;
    std::uint16_t channels = 3;
    std::uint16_t bits = 16;
    std::uint16_t kind = SAMPLEFORMAT_UINT;
    std::uint16_t planar = PLANARCONFIG_CONTIG;
    std::uint16_t photometric = PHOTOMETRIC_RGB;
    std::uint16_t compression = COMPRESSION_NONE;
    std::uint16_t orientation = ORIENTATION_TOPLEFT;
    std::uint32_t tile = 0;  ///< side of the tiles; 0: strips
    const char* mode = "w";  ///< wb: big endian
    const char* description = "";
};

/// What the file holds at a place: all numbers of a page differ.
unsigned number_at(const Layout& layout, std::uint32_t row, std::uint32_t col,
                   std::uint32_t channel) {
    return (row * layout.cols + col) * 4 + channel + 1;
}

void append(std::string& bytes, const Layout& layout, unsigned number) {
    const auto put = [&bytes](auto value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    if (layout.kind == SAMPLEFORMAT_IEEEFP)
        put(static_cast<float>(number));
    else if (layout.bits == 8)
        put(static_cast<std::uint8_t>(number));
    else if (layout.bits == 16)
        put(static_cast<std::uint16_t>(number));
    else
        put(static_cast<std::uint32_t>(number));
}

/// The numbers of a rectangle, of one channel or (-1) of all.
std::string rectangle(const Layout& layout, std::uint32_t row0, std::uint32_t col0,
                      std::uint32_t rows, std::uint32_t cols, int channel) {
    std::string bytes;
    for (std::uint32_t row = row0; row < row0 + rows; ++row)
        for (std::uint32_t col = col0; col < col0 + cols; ++col)
            for (std::uint16_t c = 0; c < layout.channels; ++c)
                if (channel < 0 || channel == c)
                    append(bytes, layout, number_at(layout, row, col, c));
    return bytes;
}

void write_page(TIFF* tiff, const Layout& layout) {
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, layout.rows);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, layout.cols);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, layout.channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, layout.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, layout.kind);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, layout.planar);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, layout.photometric);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, layout.compression);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, layout.orientation);
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, layout.description);
    const bool apart = layout.planar == PLANARCONFIG_SEPARATE;
    if (layout.tile > 0) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, layout.tile);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, layout.tile);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
    }
    for (int channel = apart ? 0 : -1; channel < (apart ? layout.channels : 0); ++channel) {
        const auto plane = static_cast<std::uint16_t>(std::max(channel, 0));
        for (std::uint32_t row = 0; layout.tile == 0 && row < layout.rows; ++row) {
            std::string bytes = rectangle(layout, row, 0, 1, layout.cols, channel);
            ASSERT_EQ(TIFFWriteScanline(tiff, bytes.data(), row, plane), 1);
        }
        for (std::uint32_t row = 0; layout.tile > 0 && row < layout.rows; row += layout.tile)
            for (std::uint32_t col = 0; col < layout.cols; col += layout.tile) {
                std::string bytes = rectangle(layout, row, col, layout.tile, layout.tile, channel);
                ASSERT_GT(TIFFWriteTile(tiff, bytes.data(), col, row, 0, plane), 0);
            }
    }
    ASSERT_EQ(TIFFWriteDirectory(tiff), 1);
}

class TiffFileTest : public testing::Test {
  protected:
    void write(const std::vector<Layout>& pages) {
        TIFF* tiff = TIFFOpen(file_.c_str(), pages.front().mode);
        for (const Layout& page : pages) write_page(tiff, page);
        TIFFClose(tiff);
    }
    /// The only error, with nothing on standard error.
    std::string problem() {
        testing::internal::CaptureStderr();
        const auto message = message_of<InputError>([&] { read_all(file_); });
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        return message;
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "f.tif";
};

/// Planes of the colour channels, at their scale.
Floats light_of(const Layout& layout) {
    const double most = layout.kind == SAMPLEFORMAT_IEEEFP ? 1 : layout.bits == 8 ? 255 : 65535;
    const unsigned white = layout.photometric == PHOTOMETRIC_MINISWHITE ? 1 : 0;
    Floats light;
    for (std::uint32_t c = 0; c < (layout.channels < 3 ? 1U : 3U); ++c)
        for (std::uint32_t row = 0; row < layout.rows; ++row)
            for (std::uint32_t col = 0; col < layout.cols; ++col) {
                const double number = number_at(layout, row, col, c);
                light.push_back(static_cast<float>((white != 0 ? most - number : number) / most));
            }
    return light;
}

using Words = std::vector<std::uint16_t>;

TEST_F(TiffFileTest, ReadsStripsAndTilesTogetherAndApartAtAllDepths) {
    Layout layout{.compression = COMPRESSION_ADOBE_DEFLATE};
    for (layout.planar = PLANARCONFIG_CONTIG; layout.planar <= PLANARCONFIG_SEPARATE;
         ++layout.planar)
        for (layout.channels = 1; layout.channels <= 4; ++layout.channels)
            for (const std::uint16_t bits : Words{8, 16, 32})
                for (const bool tiled : {false, true})
                    for (const char* mode : {"wl", "wb", "w8"}) {
                        if (bits == 8 && tiled) continue;  // more numbers than 8 bits have
                        layout.bits = bits;
                        layout.kind = bits == 32 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT;
                        layout.photometric =
                            layout.channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
                        layout.tile = tiled ? 16 : 0;
                        layout.cols = tiled ? 18 : 5;
                        layout.mode = mode;
                        write({layout});
                        EXPECT_EQ(read_all(file_), light_of(layout))
                            << layout.channels << " channels, " << bits << " bits, planar "
                            << layout.planar << ", tiles " << tiled << ", mode " << mode;
                    }
}

TEST_F(TiffFileTest, InvertsWhereZeroIsWhite) {
    for (const std::uint16_t bits : Words{8, 16}) {
        const Layout layout{.channels = 1, .bits = bits, .photometric = PHOTOMETRIC_MINISWHITE};
        write({layout});
        EXPECT_EQ(read_all(file_), light_of(layout));
    }
}

TEST_F(TiffFileTest, ReadsPagesAsFrames) {
    const Layout page{.channels = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    const Layout deflated{
        .channels = 1, .photometric = PHOTOMETRIC_MINISBLACK, .compression = COMPRESSION_LZW};
    write({page, deflated, page});
    EXPECT_EQ(FootageReader(file_).slots(), 3);
    Floats three;
    for (int i = 0; i < 3; ++i) {
        const Floats light = light_of(page);
        three.insert(three.end(), light.begin(), light.end());
    }
    EXPECT_EQ(read_all(file_), three);
    TiffFile tiff(file_);
    TiffPixels pixels;
    for (const int n : {2, 0, 1, 1}) {
        tiff.read(n, pixels);
        EXPECT_EQ(pixels.shape, (FrameShape{3, 5, 1}));
    }
    expect_parts(message_of<InputError>([&] { return read_dn_image(file_); }),
                 {"f.tif: holds 3 images"});
}

TEST_F(TiffFileTest, NamesThePageThatDiffers) {
    const Layout page{.channels = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    const Layout wide{.cols = 6, .channels = 1, .photometric = PHOTOMETRIC_MINISBLACK};
    write({page, wide});
    expect_parts(problem(), {"f.tif: page 1: is 6 x 3 x 1", "5 x 3 x 1"});
    const Layout deep{.channels = 1, .bits = 32, .photometric = PHOTOMETRIC_MINISBLACK};
    write({page, page, deep});
    expect_parts(problem(), {"f.tif: page 2: holds samples of 32 bits (unsigned)"});
}

TEST_F(TiffFileTest, RefusesOtherKindsByOneError) {
    write({{.channels = 5, .photometric = PHOTOMETRIC_MINISBLACK}});
    expect_parts(problem(), {"f.tif: holds 5 channels; give grey or RGB"});
    write({{.bits = 32}});
    expect_parts(problem(), {"f.tif: holds samples of 32 bits (unsigned); give 8- or 16-bit"});
    write({{.kind = SAMPLEFORMAT_INT}});
    expect_parts(problem(), {"16 bits (signed or complex)"});
    write({{.channels = 4, .photometric = PHOTOMETRIC_SEPARATED}});
    expect_parts(problem(), {"neither grey nor RGB (photometric interpretation 5)"});
    write({{.orientation = ORIENTATION_BOTLEFT}});
    expect_parts(problem(), {"its rows do not run from the top left (orientation 4)"});
}

TEST_F(TiffFileTest, RefusesAStackOfImageJThatHasItsFirstPageOnly) {
    const Layout of_two{.description = "ImageJ=1.54f\nimages=2\nslices=2\n"};
    write({of_two});
    expect_parts(problem(), {"f.tif: announces 2 images, but its directories hold 1"});
    write({of_two, of_two});
    EXPECT_EQ(FootageReader(file_).slots(), 2);
}

TEST_F(TiffFileTest, NeverCrashesOnADamagedFile) {
    write({{.compression = COMPRESSION_LZW}, {.planar = PLANARCONFIG_SEPARATE}});
    const std::string whole = read_text(file_);
    testing::internal::CaptureStderr();
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const int bits : {0x01, 0xFF}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ bits);
            write_text(file_, damaged);
            try {
                read_all(file_);
            } catch (const InputError&) {
            }
        }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace stipple
