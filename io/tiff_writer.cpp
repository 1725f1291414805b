#include "io/tiff_writer.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <cassert>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

int drop_message(TIFF* /*tiff*/, void* /*data*/, const char* /*module*/, const char* /*format*/,
                 va_list /*arguments*/) {
    return 1;
}

struct Closer {
    void operator()(TIFF* file) const { TIFFClose(file); }
};

std::unique_ptr<TIFF, Closer> create(const std::filesystem::path& file, TiffWriter::Kind kind) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, drop_message, nullptr);
    TIFFOpenOptionsSetWarningHandlerExtR(options, drop_message, nullptr);
    std::unique_ptr<TIFF, Closer> tiff(
        TIFFOpenExt(file.c_str(), kind == TiffWriter::Kind::kStack ? "w8" : "w4", options));
    TIFFOpenOptionsFree(options);
    return tiff;
}

}  // namespace

std::string ome_xml(FrameShape shape, int slots, const ImageCoding& coding) {
    const bool words = coding.samples == SampleKind::kWord;
    std::string sizes = fmt::format(R"(SizeX="{}" SizeY="{}" SizeZ="1" SizeC="{}" SizeT="{}")",
                                    shape.cols, shape.rows, shape.planes, slots);
    if (coding.slot_s > 0) sizes += fmt::format(R"( TimeIncrement="{}")", coding.slot_s);
    if (coding.pixel_um > 0)
        sizes += fmt::format(R"( PhysicalSizeX="{0}" PhysicalSizeY="{0}")", coding.pixel_um);
    const std::string light =
        words ? fmt::format("Linear light; 65535 is light {}", coding.full_scale) : "Linear light";
    return fmt::format(
        R"(<?xml version="1.0" encoding="UTF-8"?>)"
        R"(<OME xmlns="http://www.openmicroscopy.org/Schemas/OME/2016-06">)"
        R"(<Image ID="Image:0"><Description>{}</Description>)"
        R"(<Pixels ID="Pixels:0" DimensionOrder="XYCZT" Type="{}" {}>)"
        R"(<Channel ID="Channel:0:0" SamplesPerPixel="{}"/><TiffData/></Pixels></Image></OME>)",
        light, words ? "uint16" : "float", sizes, shape.planes);
}

struct TiffWriter::Impl {
    std::string where;
    FrameShape shape;
    ImageCoding coding;
    Kind kind;
    std::unique_ptr<TIFF, Closer> tiff;
    std::vector<std::byte> bytes;
    int pages = 0;

    /// \throws DeviceError with the reason of the system, unless `succeeded`.
    void check(bool succeeded) const {
        if (succeeded) return;
        if (errno != 0) throw write_failure(where, errno);
        throw DeviceError(where, "cannot be written: libtiff refuses it");
    }
    void describe_page();
};

void TiffWriter::Impl::describe_page() {
    const bool words = coding.samples == SampleKind::kWord;
    TIFF* const file = tiff.get();
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(shape.cols));
    TIFFSetField(file, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(shape.rows));
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, words ? 16 : 32);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, words ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
    TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, shape.planes);
    TIFFSetField(file, TIFFTAG_PHOTOMETRIC,
                 shape.planes == 1 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
    TIFFSetField(file, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(shape.rows));
    if (kind == Kind::kStack && pages == 0)
        TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION, ome_xml(shape, 1, coding).c_str());
}

TiffWriter::TiffWriter(const std::filesystem::path& file, const std::string& where,
                       FrameShape shape, const ImageCoding& coding, Kind kind)
    : impl_(new Impl{where, shape, coding, kind, create(file, kind), {}}) {
    assert(coding.samples && *coding.samples != SampleKind::kHalf);
    impl_->check(impl_->tiff != nullptr);
}

TiffWriter::~TiffWriter() = default;
TiffWriter::TiffWriter(TiffWriter&&) noexcept = default;
TiffWriter& TiffWriter::operator=(TiffWriter&&) noexcept = default;

void TiffWriter::write(std::span<const float> frame) {
    Impl& own = *impl_;
    errno = 0;
    own.describe_page();
    interleave(frame, own.shape, own.coding, own.bytes);
    const auto size = static_cast<tmsize_t>(own.bytes.size());
    own.check(TIFFWriteEncodedStrip(own.tiff.get(), 0, own.bytes.data(), size) == size);
    own.check(TIFFWriteDirectory(own.tiff.get()) == 1);
    ++own.pages;
}

void TiffWriter::finish() {
    Impl& own = *impl_;
    errno = 0;
    if (own.kind == Kind::kStack && own.pages > 1) {
        TIFF* const file = own.tiff.get();
        own.check(TIFFSetDirectory(file, 0) == 1);
        TIFFSetField(file, TIFFTAG_IMAGEDESCRIPTION,
                     ome_xml(own.shape, own.pages, own.coding).c_str());
        own.check(TIFFRewriteDirectory(file) == 1);
    }
    own.check(TIFFFlush(own.tiff.get()) == 1);
    own.tiff.reset();
}

}  // namespace stipple
