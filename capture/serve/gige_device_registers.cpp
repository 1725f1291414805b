#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "capture/serve/big_endian.h"
#include "capture/serve/gige_device.h"
#include "capture/serve/gige_xml.h"
#include "capture/serve/gvsp_codec.h"

namespace stipple {
namespace {

constexpr std::uint32_t kProtocolVersion = 0x00010002;  // 1.2
constexpr std::uint32_t kBigEndianUtf8 = 0x80000001;
constexpr std::uint32_t kTicksPerS = 1'000'000'000;
constexpr std::uint32_t kDefaultHeartbeatMs = 3000;
constexpr std::uint32_t kDefaultPacketBytes = 1500;
constexpr std::uint32_t kMinPacketBytes = 128;
constexpr std::uint32_t kPersistentIp = 0x5;
constexpr std::uint32_t kHasUserName = 0x80000000;
constexpr std::uint32_t kHasSerial = 0x40000000;
constexpr std::uint32_t kConcatenation = 1;
constexpr std::uint32_t kWriteMemory = 2;

bool is_in(std::uint32_t address, std::uint32_t first, std::uint32_t bytes) {
    return address >= first && address - first < bytes;
}

}  // namespace

void GigeDevice::fill_bootstrap(const GigeIdentity& identity) {
    set_word(gige::kVersion, kProtocolVersion);
    set_word(gige::kDeviceMode, kBigEndianUtf8);
    set_word(gige::kMacHigh, static_cast<std::uint32_t>(identity.mac >> 32U));
    set_word(gige::kMacLow, static_cast<std::uint32_t>(identity.mac));
    set_word(gige::kIpOptions, kPersistentIp);
    set_word(gige::kIpCurrent, kPersistentIp);
    set_word(gige::kIpAddress, identity.address);
    set_word(gige::kSubnetMask, identity.netmask);
    set_text(gige::kVendorName, "Stipple", 32);
    set_text(gige::kModelName, identity.model, 32);
    set_text(gige::kDeviceVersion, identity.version, 32);
    set_text(gige::kMakerInfo, "served by stipple", 48);
    set_text(gige::kSerial, identity.serial, 16);
    set_text(gige::kXmlUrl, fmt::format("Local:stipple.xml;{:X};{:X}", gige::kXmlText, xml_.size()),
             512);
    set_word(gige::kInterfaces, 1);
    set_word(gige::kStreamChannels, 1);
    set_word(gige::kCapability, kHasUserName | kHasSerial | kConcatenation | kWriteMemory |
                                    (identity.can_resend ? gige::kCanResend : 0));
    set_word(gige::kHeartbeatMs, kDefaultHeartbeatMs);
    set_word(gige::kTickFrequency + 4, kTicksPerS);
    set_word(gige::kStreamPacketSize, kDefaultPacketBytes);
}

void GigeDevice::fill_features() {
    const auto width = static_cast<std::uint32_t>(image_.width);
    const auto height = static_cast<std::uint32_t>(image_.height);
    set_word(gige::kSensorWidth, width);
    set_word(gige::kSensorHeight, height);
    set_word(gige::kWidth, width);
    set_word(gige::kHeight, height);
    set_word(gige::kPixelFormat, image_.formats.front()->pfnc);
    set_word(gige::kAcquisitionMode, gige::kContinuous);
    set_word(gige::kAcquisitionFrameCount, 1);
    set_word(gige::kFrameRate, std::bit_cast<std::uint32_t>(static_cast<float>(image_.frames_hz)));
    for (std::uint32_t i = 0; i < gige::kChunkTypes; ++i) set_word(gige::kChunkEnable + 4 * i, 1);
    set_word(gige::kStreamMode, image_.coded_header.empty() ? 0 : 1);
    set_word(gige::kExposureMapId, image_.exposure_map_id);
    const std::uint64_t frames = image_.frames.value_or(0);
    set_word(gige::kSourceFrameCount, static_cast<std::uint32_t>(frames >> 32U));
    set_word(gige::kSourceFrameCount + 4, static_cast<std::uint32_t>(frames));
    update_payload_size();
}

std::uint32_t GigeDevice::word(std::uint32_t address) const {
    return load_be<std::uint32_t>(&registers_[address]);
}

void GigeDevice::set_word(std::uint32_t address, std::uint32_t value) {
    store_be(&registers_[address], value);
}

void GigeDevice::set_text(std::uint32_t address, const std::string& text, std::size_t bytes) {
    const std::size_t used = std::min(text.size(), bytes - 1);
    std::copy_n(text.begin(), used, registers_.begin() + address);
}

void GigeDevice::update_payload_size() {
    const GigeStreamSettings now = stream();
    std::size_t bytes = now.format->row_bytes(static_cast<int>(now.width)) * now.height;
    if (now.chunk_mode) {
        bytes += 8;
        for (std::size_t i = 0; i < now.chunks.size(); ++i)
            if (now.chunks[i]) bytes += gige::kChunks[i].bytes + 8;
    }
    set_word(gige::kPayloadSize, static_cast<std::uint32_t>(bytes));
}

GigeStreamSettings GigeDevice::stream() const {
    GigeStreamSettings stream;
    stream.running = running_;
    stream.starts = starts_;
    stream.destination = {word(gige::kStreamDestination),
                          static_cast<std::uint16_t>(word(gige::kStreamPort))};
    stream.packet_bytes = word(gige::kStreamPacketSize) & 0xFFFFU;
    stream.do_not_fragment = (word(gige::kStreamPacketSize) & gige::kDoNotFragment) != 0;
    stream.packet_delay = std::chrono::nanoseconds(word(gige::kStreamPacketDelay));
    stream.format = pixel_format_of_pfnc(word(gige::kPixelFormat));
    stream.width = word(gige::kWidth);
    stream.height = word(gige::kHeight);
    stream.offset_x = word(gige::kOffsetX);
    stream.offset_y = word(gige::kOffsetY);
    stream.frames_hz = static_cast<double>(std::bit_cast<float>(word(gige::kFrameRate)));
    const std::uint32_t mode = word(gige::kAcquisitionMode);
    if (mode == gige::kSingleFrame) stream.frames = 1;
    if (mode == gige::kMultiFrame) stream.frames = word(gige::kAcquisitionFrameCount);
    stream.chunk_mode = word(gige::kChunkModeActive) != 0;
    for (std::uint32_t i = 0; i < gige::kChunkTypes; ++i)
        stream.chunks[i] = word(gige::kChunkEnable + 4 * i) != 0;
    return stream;
}

GvcpStatus GigeDevice::check_write(std::uint32_t address, std::uint32_t value) const {
    const auto when = [](bool usable) {
        return usable ? GvcpStatus::kSuccess : GvcpStatus::kInvalidParameter;
    };
    switch (address) {
        case gige::kHeartbeatMs:
            return GvcpStatus::kSuccess;
        case gige::kStreamDestination:
            return when(value == 0 || value == controller_->address || allow_other_destination_);
        case gige::kStreamPacketDelay:
            return when(value <= gige::kMaxPacketDelayNs);
        case gige::kStreamPort:
            return when(value <= 0xFFFF);
        case gige::kStreamPacketSize:
            return when((value & 0xFFFFU) >= kMinPacketBytes);
        case gige::kWidth:
        case gige::kHeight:
        case gige::kOffsetX:
        case gige::kOffsetY:
            return image_.croppable ? when(fits_region(address, value)) : GvcpStatus::kWriteProtect;
        case gige::kPixelFormat:
            return when(std::any_of(image_.formats.begin(), image_.formats.end(),
                                    [&](const auto* format) { return format->pfnc == value; }));
        case gige::kAcquisitionMode:
            return when(value <= gige::kContinuous);
        case gige::kAcquisitionFrameCount:
            return when(value >= 1);
        case gige::kFrameRate: {
            const float rate = std::bit_cast<float>(value);
            return when(rate >= static_cast<float>(ServedImage::kMinFramesHz) &&
                        rate <= static_cast<float>(image_.frames_hz));
        }
        case gige::kChunkModeActive:
            return when(value <= 1);
        case gige::kChunkSelector:
            return when(value < gige::kChunkTypes);
        default:
            break;
    }
    if (is_in(address, gige::kUserName, 16)) return GvcpStatus::kSuccess;
    if (is_in(address, gige::kChunkEnable, 4 * gige::kChunkTypes)) return when(value <= 1);
    return GvcpStatus::kWriteProtect;
}

bool GigeDevice::fits_region(std::uint32_t address, std::uint32_t value) const {
    const bool horizontal = address == gige::kWidth || address == gige::kOffsetX;
    const bool side = address == gige::kWidth || address == gige::kHeight;
    const std::uint32_t row_step = image_.formats.front()->filter == ColourFilter::kNone ? 1 : 2;
    const auto step = horizontal ? static_cast<std::uint32_t>(gige_width_step(image_)) : row_step;
    const std::uint32_t sensor = word(horizontal ? gige::kSensorWidth : gige::kSensorHeight);
    const std::uint32_t other = word(horizontal ? (side ? gige::kOffsetX : gige::kWidth)
                                                : (side ? gige::kOffsetY : gige::kHeight));
    if (value % step != 0 || (side && value == 0)) return false;
    return value <= sensor && other <= sensor - value;
}

}  // namespace stipple
