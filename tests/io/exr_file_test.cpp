#include "io/exr_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/memory_limit.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// A 2 x 3 image, all channels 0, 1, 2, ... in scan order plus 10 times their place in the list.
void write_channels(const std::filesystem::path& file, const std::vector<std::string>& names,
                    Imf::PixelType type, Imf::Header header = Imf::Header(3, 2)) {
    std::vector<half> halves(6 * names.size());
    Floats floats(6 * names.size());
    Imf::FrameBuffer planes;
    for (std::size_t c = 0; c < names.size(); ++c) {
        for (std::size_t i = 0; i < 6; ++i) {
            floats[6 * c + i] = static_cast<float>(10 * c + i);
            halves[6 * c + i] = half(floats[6 * c + i]);
        }
        header.channels().insert(names[c], Imf::Channel(type));
        char* plane = type == Imf::HALF ? reinterpret_cast<char*>(&halves[6 * c])
                                        : reinterpret_cast<char*>(&floats[6 * c]);
        const std::size_t step = type == Imf::HALF ? sizeof(half) : sizeof(float);
        planes.insert(names[c], Imf::Slice::Make(type, plane, header.dataWindow(), step, 3 * step));
    }
    Imf::OutputFile output(file.c_str(), header, 0);
    output.setFrameBuffer(planes);
    output.writePixels(2);
}

class ExrFileTest : public testing::Test {
  protected:
    Image read() {
        Image image;
        read_exr(file_, image);
        return image;
    }
    std::string problem() {
        return message_of<InputError>([&] { read(); });
    }

    TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "f.exr";
};

TEST_F(ExrFileTest, ReadsHalfAndFloatColourAsPlanes) {
    Floats expected;
    for (const float plane : {20.0F, 10.0F, 0.0F})
        for (int i = 0; i < 6; ++i) expected.push_back(plane + static_cast<float>(i));
    for (const auto type : {Imf::HALF, Imf::FLOAT}) {
        write_channels(file_, {"B", "G", "R", "A", "Z"}, type);
        EXPECT_EQ(read().shape, (FrameShape{2, 3, 3}));
        EXPECT_EQ(read().values, expected);
    }
}

TEST_F(ExrFileTest, ReadsASingleChannelAsMono) {
    for (const char* name : {"Y", "R", "light"}) {
        write_channels(file_, {name, "A"}, Imf::HALF);
        EXPECT_EQ(read().shape, (FrameShape{2, 3, 1}));
        EXPECT_EQ(read().values, (Floats{0, 1, 2, 3, 4, 5}));
    }
}

TEST_F(ExrFileTest, RefusesChannelsThatAreNeitherMonoNorColour) {
    write_channels(file_, {"R", "G"}, Imf::HALF);
    expect_parts(problem(), {"f.exr: holds the channels G, R; give R, G, B or Y alone"});
    write_channels(file_, {"X", "Y", "Z"}, Imf::HALF);
    expect_parts(problem(), {"f.exr: holds CIE XYZ colour"});
    write_channels(file_, {"Z", "A"}, Imf::FLOAT);
    expect_parts(problem(), {"f.exr: holds distances (channel Z), no light"});
    write_channels(file_, {"A"}, Imf::HALF);
    expect_parts(problem(), {"f.exr: holds the channels ;"});
}

TEST_F(ExrFileTest, ReadsWindowsThatDoNotBeginAtZero) {
    const Imath::Box2i window({-5, 7}, {-3, 8});
    write_channels(file_, {"Y"}, Imf::FLOAT, Imf::Header(window, window));
    EXPECT_EQ(read().values, (Floats{0, 1, 2, 3, 4, 5}));
}

/// Pixel (x, y) of a 3 x 2 data window that begins at (left, top); elsewhere 0.
float pixel_of(int x, int y, int left, int top) {
    const bool has_data = x >= left && x < left + 3 && y >= top && y < top + 2;
    return has_data ? static_cast<float>(3 * (y - top) + x - left) : 0;
}

TEST_F(ExrFileTest, ShowsItsDisplayWindowWhateverHasData) {
    const Imath::Box2i display({-1, 2}, {3, 5});
    for (int top = -1; top < 8; ++top)
        for (int left = -5; left < 6; ++left) {
            const Imath::Box2i data({left, top}, {left + 2, top + 1});
            write_channels(file_, {"B", "G", "R"}, Imf::FLOAT, Imf::Header(display, data));
            Floats expected;
            for (const float plane : {20.0F, 10.0F, 0.0F})
                for (int y = 2; y <= 5; ++y)
                    for (int x = -1; x <= 3; ++x) {
                        const bool outside = x < left || x > left + 2 || y < top || y > top + 1;
                        expected.push_back(outside ? 0 : plane + pixel_of(x, y, left, top));
                    }
            const Image image = read();
            EXPECT_EQ(image.shape, (FrameShape{4, 5, 3}));
            EXPECT_EQ(image.values, expected) << left << ' ' << top;
        }
}

TEST_F(ExrFileTest, RefusesADisplayWindowBeyondMemory) {
    const MemoryLimit limit(std::uint64_t{1} << 20U);
    for (const int last : {999, 65534}) {
        const Imath::Box2i display({0, 0}, {last, last});
        write_channels(file_, {"Y"}, Imf::FLOAT, Imf::Header(display, {{0, 0}, {2, 1}}));
        expect_parts(problem(), {"f.exr: ", last == 999 ? "memory" : "outside"});
    }
}

TEST_F(ExrFileTest, ConvertsThePrimariesThatItDeclares) {
    Imf::Header header(3, 2);
    Imf::addChromaticities(header, {{1, 0}, {0, 1}, {0, 0}, {1.0F / 3, 1.0F / 3}});
    write_channels(file_, {"R", "G", "B"}, Imf::FLOAT, header);  // X = i, Y = 10 + i, Z = 20 + i
    const Image image = read();
    ASSERT_EQ(image.traits.warnings.size(), 1);
    expect_parts(image.traits.warnings[0].text(), {"declares other primaries than Rec. 709"});
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(0.2126F * image.values[i] + 0.7152F * image.values[6 + i] +
                        0.0722F * image.values[12 + i],
                    10 + static_cast<float>(i), 2e-3);
    write_channels(file_, {"Y"}, Imf::FLOAT, header);
    EXPECT_EQ(read().values, (Floats{0, 1, 2, 3, 4, 5}));
    Imf::addChromaticities(header, Imf::Chromaticities());
    write_channels(file_, {"R", "G", "B"}, Imf::FLOAT, header);
    EXPECT_EQ(read().values[17], 25);
    EXPECT_TRUE(read().traits.warnings.empty());
    Imf::addChromaticities(header, {{1, 0}, {1, 0}, {0, 0}, {0.3F, 0.3F}});
    write_channels(file_, {"R", "G", "B"}, Imf::FLOAT, header);
    expect_parts(problem(), {"f.exr: declares chromaticities that make no colours"});
}

TEST_F(ExrFileTest, SaysThatItReadsTheFirstOfSeveralParts) {
    std::vector<Imf::Header> headers(2, Imf::Header(3, 2));
    for (std::size_t i = 0; i < 2; ++i) {
        headers[i].setName(i == 0 ? "left" : "right");
        headers[i].setType(Imf::SCANLINEIMAGE);
        headers[i].channels().insert("Y", Imf::Channel(Imf::FLOAT));
    }
    {
        Imf::MultiPartOutputFile output(file_.c_str(), headers.data(), 2, false, 0);
        for (int i = 0; i < 2; ++i) {
            Floats light(6, static_cast<float>(i + 1));
            Imf::FrameBuffer planes;
            planes.insert("Y", Imf::Slice::Make(Imf::FLOAT, light.data(), headers[0].dataWindow()));
            Imf::OutputPart part(output, i);
            part.setFrameBuffer(planes);
            part.writePixels(2);
        }
    }
    const Image image = read();
    EXPECT_EQ(image.values, Floats(6, 1));
    ASSERT_EQ(image.traits.warnings.size(), 1);
    expect_parts(image.traits.warnings[0].text(), {"has 2 parts, of which the first is read"});
}

TEST_F(ExrFileTest, ReadsRateAndExposure) {
    Imf::Header header(3, 2, 2.0F);
    Imf::addFramesPerSecond(header, {24000, 1001});
    Imf::addExpTime(header, 0.02F);
    write_channels(file_, {"Y"}, Imf::FLOAT, header);
    const SourceInfo traits = read().traits;
    EXPECT_DOUBLE_EQ(*traits.frames_hz, 24000.0 / 1001);
    EXPECT_NEAR(*traits.exposure_us, 20000, 1e-2);
    ASSERT_EQ(traits.warnings.size(), 1);
    expect_parts(traits.warnings[0].text(), {"pixels 2 times as wide as high"});
    Imf::addFramesPerSecond(header, {24, 0});
    Imf::addExpTime(header, -1);
    write_channels(file_, {"Y"}, Imf::FLOAT, header);
    EXPECT_FALSE(read().traits.frames_hz || read().traits.exposure_us);
}

TEST_F(ExrFileTest, NamesATruncatedFileWhateverItsLength) {
    write_channels(file_, {"R", "G", "B"}, Imf::FLOAT);
    const std::string whole = read_text(file_);
    for (std::size_t length = 0; length < whole.size(); length += 3) {
        write_text(file_, whole.substr(0, length));
        expect_parts(problem(), {"f.exr: "});
    }
}

TEST_F(ExrFileTest, NeverCrashesOnADamagedFile) {
    write_channels(file_, {"Y"}, Imf::FLOAT);
    const std::string whole = read_text(file_);
    for (std::size_t i = 0; i < whole.size(); ++i)
        for (const int bits : {0x01, 0x80, 0xFF}) {
            std::string damaged = whole;
            damaged[i] = static_cast<char>(damaged[i] ^ bits);
            write_text(file_, damaged);
            try {
                read();
            } catch (const InputError&) {
            }
        }
}

TEST_F(ExrFileTest, RefusesAListOfChannelsThatEndsElsewhereThanDeclared) {
    write_channels(file_, {"Y"}, Imf::FLOAT);
    std::string bytes = read_text(file_);
    const std::string_view kind("channels\0chlist", 16);  // with the end of each
    bytes[bytes.find(kind) + kind.size()] = 18;
    write_text(file_, bytes);
    expect_parts(problem(), {"f.exr: cannot be read as OpenEXR: its attribute channels declares 18 "
                             "bytes, but its list of channels has 19"});
}

TEST_F(ExrFileTest, ReadsWhatItWroteBitByBit) {
    for (const int planes : {1, 3}) {
        const FrameShape shape{37, 21, planes};  // not a multiple of the 16 rows of a ZIP block
        Floats frame(shape.sites());
        for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = 0.1F * static_cast<float>(i);
        write_exr(file_, "f.exr", shape, frame);
        EXPECT_EQ(read().shape, shape);
        EXPECT_EQ(read().values, frame);
    }
}

TEST_F(ExrFileTest, WritesTheSameBytesForTheSameFrame) {
    const Floats frame(12, 0.5F);
    write_exr(file_, "f.exr", {2, 2, 3}, frame);
    const std::string first = read_text(file_);
    write_exr(file_, "f.exr", {2, 2, 3}, frame);
    EXPECT_EQ(read_text(file_), first);
}

}  // namespace
}  // namespace stipple
