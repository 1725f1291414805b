#include "io/exr_file.h"

#include <IlmThreadPool.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <fmt/format.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "io/output_file.h"
#include "io/primaries.h"

namespace stipple {
namespace {

constexpr int kThreads = 0;

/// What is wrong with a header, in words of OpenEXRCore.
struct HeaderFault {
    std::array<char, 160> text{};
    bool no_memory = false;
};

void note_fault(exr_const_context_t context, exr_result_t code, const char* text) {
    void* data = nullptr;
    if (exr_get_user_data(context, &data) != EXR_ERR_SUCCESS || data == nullptr) return;
    auto& fault = *static_cast<HeaderFault*>(data);
    if (code == EXR_ERR_OUT_OF_MEMORY) fault.no_memory = true;
    if (fault.text[0] != '\0') return;
    std::string_view(text).copy(fault.text.data(), fault.text.size() - 1);
    std::ranges::replace(fault.text, '\n', ' ');  // of a name
}

/// OpenEXRCore compares all sizes in the header with the file. OpenEXR's own class believes them,
/// and takes as much memory. \returns the number of parts. \throws std::runtime_error if the header
/// is damaged.
int check_header(const std::filesystem::path& file) {
    HeaderFault fault;
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    settings.error_handler_fn = note_fault;
    settings.user_data = &fault;
    exr_context_t context = nullptr;
    const exr_result_t code = exr_start_read(&context, file.c_str(), &settings);
    int parts = 1;
    if (code == EXR_ERR_SUCCESS) exr_get_count(context, &parts);
    exr_finish(&context);
    if (fault.no_memory || code == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (code == EXR_ERR_SUCCESS && fault.text[0] == '\0') return parts;
    throw std::runtime_error(fault.text[0] == '\0' ? exr_get_default_error_message(code)
                                                   : fault.text.data());
}

/// OpenEXRCore goes by the bytes that a list of channels declares, OpenEXR's own class by its end:
/// where they differ, the two take different bytes for the next attribute. For a header that
/// OpenEXRCore can read. \throws std::runtime_error if they differ.
void check_channel_lists(const std::filesystem::path& file) {
    constexpr int kVersionFlags = 5;  // of the file, a byte
    constexpr int kFirstAttribute = 8;
    constexpr int kMultiPart = 0x10;
    constexpr int kBytesAfterName = 16;  // of a channel: its type, flags and sampling
    std::ifstream in(file, std::ios::binary);
    in.seekg(kVersionFlags);
    const bool multi_part = (in.get() & kMultiPart) != 0;
    in.seekg(kFirstAttribute);
    bool part_ended = false;
    for (std::string name, type; std::getline(in, name, '\0');) {
        if (name.empty() && (part_ended || !multi_part)) return;
        part_ended = name.empty();
        if (part_ended) continue;
        std::getline(in, type, '\0');
        std::array<std::uint8_t, 4> size{};
        in.read(reinterpret_cast<char*>(size.data()), std::ssize(size));
        const std::streamoff begin = in.tellg();
        const std::streamoff declared =
            size[0] + (size[1] << 8U) + (size[2] << 16U) + (std::streamoff{size[3]} << 24U);
        if (type == "chlist") {
            while (std::getline(in, type, '\0') && !type.empty())
                in.seekg(kBytesAfterName, std::ios::cur);
            const std::streamoff found = in.tellg() - begin;
            if (found != declared)
                throw std::runtime_error(fmt::format(
                    "its attribute {} declares {} bytes, but its list of channels has {}", name,
                    declared, found));
        }
        in.seekg(begin + declared);
    }
}

/// Names of the channels that make up the image, one a plane.
std::vector<std::string> image_channels(const Imf::ChannelList& channels,
                                        const std::string& where) {
    const auto has = [&](const char* name) { return channels.findChannel(name) != nullptr; };
    std::vector<std::string> names;
    if (has("R") && has("G") && has("B")) {
        names = {"R", "G", "B"};
    } else if (has("X") && has("Y") && has("Z")) {
        throw InputError(where, "holds CIE XYZ colour; convert it to RGB or to luminance Y alone");
    } else if (has("Y") && !has("RY") && !has("BY")) {
        names = {"Y"};
    } else {
        for (auto c = channels.begin(); c != channels.end(); ++c)
            if (std::string_view(c.name()) != "A") names.emplace_back(c.name());
        if (names.size() != 1)
            throw InputError(where, fmt::format("holds the channels {}; give R, G, B or Y alone",
                                                joined(names)));
        if (names.front() == "Z" || names.front() == "depth")
            throw InputError(where,
                             fmt::format("holds distances (channel {}), no light; give R, G, "
                                         "B or Y",
                                         names.front()));
    }
    for (const auto& name : names) {
        const Imf::Channel& channel = channels[name.c_str()];
        if (channel.xSampling != 1 || channel.ySampling != 1)
            throw InputError(where, fmt::format("channel {} is subsampled", name));
    }
    return names;
}

constexpr float kMaxHalf = 65504;

/// A plane as OpenEXR wants it: the address that pixel (0, 0) would have.
template <typename Sample>
Imf::Slice plane_slice(Sample* plane, const Imath::Box2i& window, FrameShape shape) {
    const auto type = std::is_same_v<Sample, float> ? Imf::FLOAT : Imf::HALF;
    return Imf::Slice::Make(type, plane, window, sizeof(Sample),
                            sizeof(Sample) * static_cast<std::size_t>(shape.cols));
}

std::uint64_t side(int low, int high) {
    return high < low ? 0 : static_cast<std::uint64_t>(std::int64_t{high} - low + 1);
}

/// \throws InputError if the file is too short for its pixels.
void check_size(const Imf::Header& header, const std::vector<std::string>& names, FrameShape shape,
                const std::string& where) {
    std::uint64_t pixel_bytes = 0;
    for (const auto& name : names)
        pixel_bytes += header.channels()[name.c_str()].type == Imf::HALF ? 2U : 4U;
    // DWA packs what Deflate takes by blocks of 8 x 8 pixels.
    const auto packing = header.compression();
    const bool blocks = packing == Imf::DWAA_COMPRESSION || packing == Imf::DWAB_COMPRESSION;
    const std::uint64_t bytes = std::filesystem::file_size(where);
    check_packed(pixel_bytes * shape.pixels(), bytes, where,
                 blocks ? 64 * kDeflateRatio : kDeflateRatio);
    check_memory(sizeof(float) * shape.pixels() * names.size(), where, "the image", bytes);
}

FrameShape checked_shape_of(const Imath::Box2i& window, std::size_t planes,
                            const std::string& where) {
    return checked_shape(side(window.min.y, window.max.y), side(window.min.x, window.max.x), planes,
                         where);
}

/// The image of the display window from that of the data window. Pixels without data are 0.
void fit_to_display(const Imath::Box2i& data, const Imath::Box2i& display, const std::string& where,
                    Image& image) {
    const FrameShape shape =
        checked_shape_of(display, static_cast<std::size_t>(image.shape.planes), where);
    check_memory(sizeof(float) * (shape.sites() + image.shape.sites()), where,
                 "the image of its display window", std::filesystem::file_size(where));
    std::vector<float> shown(shape.sites());
    const std::int64_t top = std::int64_t{data.min.y} - display.min.y;
    const std::int64_t left = std::int64_t{data.min.x} - display.min.x;
    const std::int64_t begin = std::max<std::int64_t>(left, 0);
    const std::int64_t end = std::min<std::int64_t>(left + image.shape.cols, shape.cols);
    const std::int64_t rows = std::min<std::int64_t>(top + image.shape.rows, shape.rows);
    for (std::int64_t plane = 0; plane < shape.planes; ++plane)
        for (std::int64_t row = std::max<std::int64_t>(top, 0); row < rows && begin < end; ++row) {
            const std::int64_t stored = plane * image.shape.rows + row - top;
            const auto* const from = image.values.data() + stored * image.shape.cols + begin - left;
            std::copy(from, from + end - begin,
                      shown.data() + (plane * shape.rows + row) * shape.cols + begin);
        }
    image.shape = shape;
    image.values = std::move(shown);
}

/// Rate and exposure, and what is declared and not applied.
void read_attributes(const Imf::Header& header, SourceInfo& traits) {
    constexpr double kMicrosecondsPerSecond = 1e6;
    if (Imf::hasFramesPerSecond(header)) {
        const Imf::Rational rate = Imf::framesPerSecond(header);
        if (rate.n > 0 && rate.d > 0) traits.frames_hz = static_cast<double>(rate);
    }
    if (Imf::hasExpTime(header)) {
        const auto seconds = static_cast<double>(Imf::expTime(header));
        if (seconds > 0 && std::isfinite(seconds))
            traits.exposure_us = kMicrosecondsPerSecond * seconds;
    }
    if (header.pixelAspectRatio() != 1)
        traits.warnings.push_back(fmt::format(
            "declares pixels {:.4g} times as wide as high; they are taken for square ones",
            header.pixelAspectRatio()));
}

/// To the primaries of Rec. 709, which all light here has.
void convert_colours(const Imf::Header& header, const std::string& where, Image& image) {
    if (image.shape.planes != 3 || !Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities& declared = Imf::chromaticities(header);
    const auto at = [](const Imath::V2f& colour) {
        return Chromaticity{static_cast<double>(colour.x), static_cast<double>(colour.y)};
    };
    const auto matrix =
        to_rec709({at(declared.red), at(declared.green), at(declared.blue), at(declared.white)});
    if (!matrix)
        throw InputError(where,
                         "declares chromaticities that make no colours; correct or remove "
                         "the attribute first");
    if (is_identity(*matrix)) return;
    convert(image.values, *matrix);
    image.traits.warnings.emplace_back(
        "declares other primaries than Rec. 709, to which its colours are converted");
}

void read_planes(Imf::InputFile& input, const std::string& where, Image& image) {
    const Imath::Box2i window = input.header().dataWindow();
    const auto names = image_channels(input.header().channels(), where);
    image.traits = {.floating = true,
                    .has_alpha = input.header().channels().findChannel("A") != nullptr};
    const bool half = input.header().channels()[names.front().c_str()].type == Imf::HALF;
    image.traits.sample_format = half ? "float16" : "float32";
    const FrameShape shape = checked_shape_of(window, names.size(), where);
    check_size(input.header(), names, shape, where);
    image.resize(shape);
    Imf::FrameBuffer planes;
    for (std::size_t i = 0; i < names.size(); ++i)
        planes.insert(names[i], plane_slice(image.values.data() + i * image.shape.pixels(), window,
                                            image.shape));
    input.setFrameBuffer(planes);
    input.readPixels(window.min.y, window.max.y);
    read_attributes(input.header(), image.traits);
    convert_colours(input.header(), where, image);
    const Imath::Box2i& display = input.header().displayWindow();
    if (window != display) fit_to_display(window, display, where, image);
}

/// The file of an image, in memory: OpenEXR swallows errors that occur when a file is closed.
std::string encoded(const Imf::Header& header, const Imf::FrameBuffer& planes,
                    std::string_view where) {
    // Here, as a pool that cannot be made while tasks wait for it is waited for without end.
    static_cast<void>(IlmThread::ThreadPool::globalThreadPool());
    try {
        Imf::StdOSStream stream;
        {
            Imf::OutputFile output(stream, header, kThreads);
            output.setFrameBuffer(planes);
            output.writePixels(header.dataWindow().size().y + 1);
        }
        // Rows that zlib has no memory for are left out without a word.
        Imf::StdISStream written;
        written.str(stream.str());
        if (!Imf::InputFile(written, kThreads).isComplete()) throw std::bad_alloc();
        return stream.str();
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw DeviceError(where, fmt::format("cannot be written as OpenEXR: {}", e.what()));
    }
}

/// A file with channels of this type.
template <typename Sample, typename Convert>
std::string encoded_as(FrameShape shape, std::span<const float> frame, std::string_view where,
                       Convert convert) {
    Imf::Header header(shape.cols, shape.rows);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer planes;
    std::vector<Sample> values(frame.size());  // OpenEXR wants a mutable pointer
    std::ranges::transform(frame, values.begin(), convert);
    for (int p = 0; p < shape.planes; ++p) {
        const char* name = shape.planes == 1 ? "Y" : &"R\0G\0B\0"[2 * p];
        Sample* plane = values.data() + static_cast<std::size_t>(p) * shape.pixels();
        const Imf::Slice slice = plane_slice(plane, header.dataWindow(), shape);
        header.channels().insert(name, Imf::Channel(slice.type));
        planes.insert(name, slice);
    }
    return encoded(header, planes, where);
}

}  // namespace

void read_exr(const std::filesystem::path& file, Image& image) {
    try {
        const int parts = check_header(file);
        check_channel_lists(file);
        Imf::InputFile input(file.c_str(), kThreads);
        read_planes(input, file.string(), image);
        if (parts > 1)
            image.traits.warnings.push_back(
                fmt::format("has {} parts, of which the first is read", parts));
    } catch (const InputError&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(file.string(), fmt::format("cannot be read as OpenEXR: {}", e.what()));
    }
}

void write_exr(const std::filesystem::path& file, std::string_view where, FrameShape shape,
               std::span<const float> frame, ExrSample sample) {
    assert(frame.size() == shape.sites());
    const std::string bytes =
        sample == ExrSample::kFloat
            ? encoded_as<float>(shape, frame, where, [](float light) { return light; })
            : encoded_as<half>(shape, frame, where,
                               [](float light) { return half(std::min(light, kMaxHalf)); });
    OutputFile output(file, std::string(where));
    output.write(std::as_bytes(std::span(bytes)));
    output.close();
}

}  // namespace stipple
