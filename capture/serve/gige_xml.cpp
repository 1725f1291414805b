#include "capture/serve/gige_xml.h"

#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "capture/serve/gige_registers.h"

namespace stipple {
namespace {

/// What the placeholders of the templates stand for, by name.
using Values = fmt::dynamic_format_arg_store<fmt::format_context>;

constexpr std::pair<const char*, std::uint32_t> kConstants[] = {
    {"VendorName", gige::kVendorName},
    {"ModelName", gige::kModelName},
    {"DeviceVersion", gige::kDeviceVersion},
    {"MakerInfo", gige::kMakerInfo},
    {"Serial", gige::kSerial},
    {"UserName", gige::kUserName},
    {"HeartbeatMs", gige::kHeartbeatMs},
    {"MinHeartbeatMs", gige::kMinHeartbeatMs},
    {"MaxHeartbeatMs", gige::kMaxHeartbeatMs},
    {"TickFrequency", gige::kTickFrequency},
    {"StreamPacketSize", gige::kStreamPacketSize},
    {"StreamPacketDelay", gige::kStreamPacketDelay},
    {"MaxPacketDelayNs", gige::kMaxPacketDelayNs},
    {"SensorWidth", gige::kSensorWidth},
    {"SensorHeight", gige::kSensorHeight},
    {"Width", gige::kWidth},
    {"Height", gige::kHeight},
    {"OffsetX", gige::kOffsetX},
    {"OffsetY", gige::kOffsetY},
    {"PixelFormat", gige::kPixelFormat},
    {"PayloadSize", gige::kPayloadSize},
    {"AcquisitionMode", gige::kAcquisitionMode},
    {"SingleFrame", gige::kSingleFrame},
    {"MultiFrame", gige::kMultiFrame},
    {"Continuous", gige::kContinuous},
    {"AcquisitionStart", gige::kAcquisitionStart},
    {"AcquisitionStop", gige::kAcquisitionStop},
    {"AcquisitionFrameCount", gige::kAcquisitionFrameCount},
    {"FrameRate", gige::kFrameRate},
    {"ChunkModeActive", gige::kChunkModeActive},
    {"ChunkSelector", gige::kChunkSelector},
    {"ChunkEnable", gige::kChunkEnable},
    {"ParametersLocked", gige::kParametersLocked},
    {"StreamMode", gige::kStreamMode},
    {"ExposureMapId", gige::kExposureMapId},
    {"SourceFrameCount", gige::kSourceFrameCount},
    {"CodedHeader", gige::kCodedHeader}};

Values values_of(const ServedImage& image) {
    Values values;
    const auto add = [&](const std::string& name, const auto& value) {
        values.push_back(fmt::arg(name.c_str(), value));
    };
    for (const auto& [name, value] : kConstants) add(name, value);
    for (const gige::Chunk& chunk : gige::kChunks) {
        add(fmt::format("Chunk{}Id", chunk.name), chunk.id);
        add(fmt::format("Chunk{}Bytes", chunk.name), chunk.bytes);
    }
    std::string formats;
    for (const PixelFormat* format : image.formats)
        formats += fmt::format("<EnumEntry Name=\"{}\"><Value>{}</Value></EnumEntry>", format->name,
                               format->pfnc);
    add("formats", formats);
    add("width", image.width);
    add("height", image.height);
    add("col_step", gige_width_step(image));
    add("row_step", image.formats.front()->filter == ColourFilter::kNone ? 1 : 2);
    add("min_frames_hz", ServedImage::kMinFramesHz);
    // The register holds it as a float, which may be the larger.
    add("max_frames_hz",
        std::max(image.frames_hz, static_cast<double>(static_cast<float>(image.frames_hz))));
    add("coded_header_bytes", image.coded_header.size() / 4 * 4 + 4);
    return values;
}

}  // namespace

int gige_width_step(const ServedImage& image) {
    int step = 1;
    for (const PixelFormat* format : image.formats) {
        step = std::lcm(step, 8 / std::gcd(8, format->bits_per_pixel));
        if (format->filter != ColourFilter::kNone) step = std::lcm(step, 2);
    }
    return step;
}

std::string gige_xml(const ServedImage& image) {
    Values values = values_of(image);
    const auto part = [&](const char* name, const char* text) {
        values.push_back(fmt::arg(name, fmt::vformat(text, values)));
    };
    const bool is_coded = !image.coded_header.empty();
    part("region", image.croppable ? gige::kRegionXml : gige::kFixedRegionXml);
    part(
        "coded_features",
        is_coded ? "<pFeature>ExposureMapID</pFeature><pFeature>CodedStreamHeader</pFeature>" : "");
    part("coded_header", is_coded ? gige::kCodedHeaderXml : "");
    return fmt::vformat(gige::kCameraXml, values);
}

}  // namespace stipple
