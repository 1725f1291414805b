#include "capture/serve/gige_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <numeric>
#include <string_view>

#include "capture/serve/gige_registers.h"

namespace stipple {
namespace {

/// Where the value of a feature lies.
struct Register {
    std::uint32_t address = 0;
    int bytes = 4;
    std::string_view access = "RO";
};

constexpr std::string_view kLocked = "<pIsLocked>TLParamsLocked</pIsLocked>";

std::string place_of(const Register& at) {
    return fmt::format(
        "<Address>{:#x}</Address><Length>{}</Length><AccessMode>{}</AccessMode>"
        "<pPort>Device</pPort><Cachable>NoCache</Cachable>",
        at.address, at.bytes, at.access);
}

std::string int_reg(std::string_view name, const Register& at) {
    return fmt::format(
        "<IntReg Name=\"{}Reg\">{}<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n",
        name, place_of(at));
}

/// `head`: elements before the value (tool tip, lock); `limits`: those after it.
std::string integer(std::string_view name, const Register& at, std::string_view head = {},
                    std::string_view limits = {}) {
    return fmt::format("<Integer Name=\"{0}\">{1}<pValue>{0}Reg</pValue>{2}</Integer>\n{3}", name,
                       head, limits, int_reg(name, at));
}

std::string boolean(std::string_view name, const Register& at, std::string_view head = {}) {
    return fmt::format(
        "<Boolean Name=\"{0}\">{1}<pValue>{0}Reg</pValue><OnValue>1</OnValue>"
        "<OffValue>0</OffValue></Boolean>\n{2}",
        name, head, int_reg(name, at));
}

std::string command(std::string_view name, std::uint32_t address) {
    return fmt::format(
        "<Command Name=\"{0}\"><pValue>{0}Reg</pValue><CommandValue>1</CommandValue></Command>\n"
        "{1}",
        name, int_reg(name, {address, 4, "WO"}));
}

std::string text(std::string_view name, const Register& at) {
    return fmt::format("<StringReg Name=\"{}\">{}</StringReg>\n", name, place_of(at));
}

std::string entry(std::string_view name, std::uint32_t value) {
    return fmt::format("<EnumEntry Name=\"{}\"><Value>{}</Value></EnumEntry>", name, value);
}

std::string enumeration(std::string_view name, const Register& at, std::string_view entries,
                        std::string_view head = {}, std::string_view selected = {}) {
    return fmt::format(
        "<Enumeration Name=\"{0}\">{1}{2}<pValue>{0}Reg</pValue>{3}</Enumeration>\n{4}", name, head,
        entries, selected, int_reg(name, at));
}

/// Bits lsb..msb of a register, counted from the highest bit on, as GenICam does in big endian.
std::string bits(std::string_view name, std::uint32_t address, int msb, int lsb) {
    return fmt::format(
        "<MaskedIntReg Name=\"{}Reg\">{}<LSB>{}</LSB><MSB>{}</MSB><Sign>Unsigned</Sign>"
        "<Endianess>BigEndian</Endianess></MaskedIntReg>\n",
        name, place_of({address, 4, "RW"}), lsb, msb);
}

std::string category(std::string_view name, std::initializer_list<std::string_view> features) {
    std::string xml = fmt::format("<Category Name=\"{}\">", name);
    for (const std::string_view feature : features)
        xml += fmt::format("<pFeature>{}</pFeature>", feature);
    return xml + "</Category>\n";
}

std::string device_control() {
    return category("DeviceControl",
                    {"DeviceVendorName", "DeviceModelName", "DeviceVersion",
                     "DeviceManufacturerInfo", "DeviceSerialNumber", "DeviceID", "DeviceUserID"}) +
           text("DeviceVendorName", {gige::kVendorName, 32}) +
           text("DeviceModelName", {gige::kModelName, 32}) +
           text("DeviceVersion", {gige::kDeviceVersion, 32}) +
           text("DeviceManufacturerInfo", {gige::kMakerInfo, 48}) +
           text("DeviceSerialNumber", {gige::kSerial, 16}) + text("DeviceID", {gige::kSerial, 16}) +
           text("DeviceUserID", {gige::kUserName, 16, "RW"});
}

/// A side of the region of which at least `step` pixels and at most `sensor` can be had.
std::string side(std::string_view name, std::uint32_t address, int step, int fixed,
                 std::string_view sensor) {
    const std::string limits =
        fixed > 0 ? fmt::format("<Min>{0}</Min><Max>{0}</Max><Inc>1</Inc>", fixed)
                  : fmt::format("<Min>{0}</Min><pMax>{1}</pMax><Inc>{0}</Inc>", step, sensor);
    return integer(name, {address, 4, fixed > 0 ? "RO" : "RW"}, kLocked, limits);
}

std::string offset(std::string_view name, std::uint32_t address, int step, bool fixed,
                   std::string_view side) {
    if (fixed) return integer(name, {address}, {}, "<Min>0</Min><Max>0</Max>");
    return integer(name, {address, 4, "RW"}, kLocked,
                   fmt::format("<Min>0</Min><pMax>{}Limit</pMax><Inc>{}</Inc>", name, step)) +
           fmt::format(
               "<IntSwissKnife Name=\"{0}Limit\"><pVariable Name=\"SENSOR\">Sensor{1}"
               "</pVariable><pVariable Name=\"SIDE\">{1}</pVariable>"
               "<Formula>SENSOR - SIDE</Formula></IntSwissKnife>\n",
               name, side);
}

std::string image_format(const ServedImage& image) {
    std::string formats;
    for (const PixelFormat* format : image.formats) formats += entry(format->name, format->pfnc);
    const int step = gige_width_step(image);
    const int row_step = image.formats.front()->filter == ColourFilter::kNone ? 1 : 2;
    const bool fixed = !image.croppable;
    return category("ImageFormatControl",
                    {"SensorWidth", "SensorHeight", "WidthMax", "HeightMax", "Width", "Height",
                     "OffsetX", "OffsetY", "PixelFormat"}) +
           integer("SensorWidth", {gige::kSensorWidth}) +
           integer("SensorHeight", {gige::kSensorHeight}) +
           integer("WidthMax", {gige::kSensorWidth}) + integer("HeightMax", {gige::kSensorHeight}) +
           side("Width", gige::kWidth, step, fixed ? image.width : 0, "SensorWidth") +
           side("Height", gige::kHeight, row_step, fixed ? image.height : 0, "SensorHeight") +
           offset("OffsetX", gige::kOffsetX, step, fixed, "Width") +
           offset("OffsetY", gige::kOffsetY, row_step, fixed, "Height") +
           enumeration("PixelFormat", {gige::kPixelFormat, 4, "RW"}, formats, kLocked);
}

std::string acquisition(double frames_per_s) {
    // The register holds it as a float, which may be the larger.
    const double most =
        std::max(frames_per_s, static_cast<double>(static_cast<float>(frames_per_s)));
    const std::string modes = entry("SingleFrame", gige::kSingleFrame) +
                              entry("MultiFrame", gige::kMultiFrame) +
                              entry("Continuous", gige::kContinuous);
    return category("AcquisitionControl", {"AcquisitionMode", "AcquisitionStart", "AcquisitionStop",
                                           "AcquisitionFrameCount", "AcquisitionFrameRate"}) +
           enumeration("AcquisitionMode", {gige::kAcquisitionMode, 4, "RW"}, modes, kLocked) +
           command("AcquisitionStart", gige::kAcquisitionStart) +
           command("AcquisitionStop", gige::kAcquisitionStop) +
           integer("AcquisitionFrameCount", {gige::kAcquisitionFrameCount, 4, "RW"}, kLocked,
                   "<Min>1</Min><Max>4294967295</Max>") +
           "<Float Name=\"AcquisitionFrameRate\">" + std::string(kLocked) +
           fmt::format(
               "<pValue>AcquisitionFrameRateReg</pValue><Min>0.01</Min><Max>{}</Max>"
               "<Unit>Hz</Unit></Float>\n",
               most) +
           fmt::format(
               "<FloatReg Name=\"AcquisitionFrameRateReg\">{}"
               "<Endianess>BigEndian</Endianess></FloatReg>\n",
               place_of({gige::kFrameRate, 4, "RW"}));
}

std::string chunk_data() {
    std::string xml =
        category("ChunkDataControl", {"ChunkModeActive", "ChunkSelector", "ChunkEnable",
                                      "ChunkSlot", "ChunkExposureMapID", "ChunkTimestamp"}) +
        boolean("ChunkModeActive", {gige::kChunkModeActive, 4, "RW"}, kLocked);
    std::string entries;
    std::uint32_t index = 0;
    for (const gige::Chunk& chunk : gige::kChunks) {
        entries += entry(chunk.name, index++);
        xml += fmt::format(
            "<Integer Name=\"Chunk{0}\"><pValue>Chunk{0}Reg</pValue></Integer>\n"
            "<IntReg Name=\"Chunk{0}Reg\"><Address>0</Address><Length>{1}</Length>"
            "<AccessMode>RO</AccessMode><pPort>Chunk{0}Port</pPort><Cachable>NoCache</Cachable>"
            "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n"
            "<Port Name=\"Chunk{0}Port\"><ChunkID>{2:x}</ChunkID></Port>\n",
            chunk.name, chunk.bytes, chunk.id);
    }
    xml += enumeration("ChunkSelector", {gige::kChunkSelector, 4, "RW"}, entries, {},
                       "<pSelected>ChunkEnable</pSelected>");
    xml += fmt::format(
        "<Boolean Name=\"ChunkEnable\">{}<pValue>ChunkEnableReg</pValue><OnValue>1</OnValue>"
        "<OffValue>0</OffValue></Boolean>\n"
        "<IntReg Name=\"ChunkEnableReg\"><Address>{:#x}</Address>"
        "<pIndex Offset=\"4\">ChunkSelectorReg</pIndex><Length>4</Length>"
        "<AccessMode>RW</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>"
        "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n",
        kLocked, gige::kChunkEnable);
    return xml;
}

std::string transport() {
    return category(
               "TransportLayerControl",
               {"PayloadSize", "TLParamsLocked", "GevHeartbeatTimeout", "GevTimestampTickFrequency",
                "GevSCPSPacketSize", "GevSCPSFireTestPacket", "GevSCPSDoNotFragment", "GevSCPD"}) +
           integer("PayloadSize", {gige::kPayloadSize}) +
           integer("TLParamsLocked", {gige::kParametersLocked}, {}, "<Min>0</Min><Max>1</Max>") +
           integer("GevHeartbeatTimeout", {gige::kHeartbeatMs, 4, "RW"}, {},
                   fmt::format("<Min>{}</Min><Max>{}</Max>", gige::kMinHeartbeatMs,
                               gige::kMaxHeartbeatMs)) +
           integer("GevTimestampTickFrequency", {gige::kTickFrequency, 8}) +
           "<Integer Name=\"GevSCPSPacketSize\"><pIsLocked>TLParamsLocked</pIsLocked>"
           "<pValue>GevSCPSPacketSizeReg</pValue><Min>128</Min><Max>65532</Max><Inc>4</Inc>"
           "</Integer>\n" +
           bits("GevSCPSPacketSize", gige::kStreamPacketSize, 16, 31) +
           "<Command Name=\"GevSCPSFireTestPacket\"><pValue>GevSCPSFireTestPacketReg</pValue>"
           "<CommandValue>1</CommandValue></Command>\n" +
           bits("GevSCPSFireTestPacket", gige::kStreamPacketSize, 0, 0) +
           "<Boolean Name=\"GevSCPSDoNotFragment\"><pValue>GevSCPSDoNotFragmentReg</pValue>"
           "<OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n" +
           bits("GevSCPSDoNotFragment", gige::kStreamPacketSize, 1, 1) +
           integer("GevSCPD", {gige::kStreamPacketDelay, 4, "RW"}, kLocked,
                   fmt::format("<Min>0</Min><Max>{}</Max>", gige::kMaxPacketDelayNs));
}

std::string source(const ServedImage& image) {
    std::string xml =
        category(
            "SourceControl",
            image.coded_header.empty()
                ? std::initializer_list<std::string_view>{"StreamMode", "SourceFrameCount"}
                : std::initializer_list<std::string_view>{"StreamMode", "SourceFrameCount",
                                                          "ExposureMapID", "CodedStreamHeader"}) +
        enumeration("StreamMode", {gige::kStreamMode}, entry("Frames", 0) + entry("Coded", 1)) +
        integer("SourceFrameCount", {gige::kSourceFrameCount, 8}) +
        integer("ExposureMapID", {gige::kExposureMapId});
    if (!image.coded_header.empty())
        xml += text("CodedStreamHeader",
                    {gige::kCodedHeader, static_cast<int>(image.coded_header.size() / 4 * 4 + 4)});
    return xml;
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
    return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
           "<RegisterDescription ModelName=\"Stipple\" VendorName=\"Stipple\" "
           "StandardNameSpace=\"GEV\" SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" "
           "SchemaSubMinorVersion=\"0\" MajorVersion=\"1\" MinorVersion=\"0\" "
           "SubMinorVersion=\"0\" ToolTip=\"Served by stipple\" "
           "ProductGuid=\"6B1A9E52-0C39-4F63-9D4B-5A0E0B0A7C11\" "
           "VersionGuid=\"0F5D27A3-93C6-4B0B-8E0D-2D6A3C4E9F20\" "
           "xmlns=\"http://www.genicam.org/GenApi/Version_1_1\">\n" +
           category("Root", {"DeviceControl", "ImageFormatControl", "AcquisitionControl",
                             "ChunkDataControl", "TransportLayerControl", "SourceControl"}) +
           device_control() + image_format(image) + acquisition(image.frames_per_s) + chunk_data() +
           transport() + source(image) + "<Port Name=\"Device\"></Port>\n</RegisterDescription>\n";
}

}  // namespace stipple
