#pragma once

#include <cstdint>

/// Addresses of the registers of a served camera: the bootstrap registers of GigE Vision, then our
/// own features, which the GenICam XML names.
namespace stipple::gige {

inline constexpr std::uint32_t kVersion = 0x0000;
inline constexpr std::uint32_t kDeviceMode = 0x0004;
inline constexpr std::uint32_t kMacHigh = 0x0008;
inline constexpr std::uint32_t kMacLow = 0x000C;
inline constexpr std::uint32_t kIpOptions = 0x0010;
inline constexpr std::uint32_t kIpCurrent = 0x0014;
inline constexpr std::uint32_t kIpAddress = 0x0024;
inline constexpr std::uint32_t kSubnetMask = 0x0034;
inline constexpr std::uint32_t kVendorName = 0x0048;     // 32 bytes
inline constexpr std::uint32_t kModelName = 0x0068;      // 32 bytes
inline constexpr std::uint32_t kDeviceVersion = 0x0088;  // 32 bytes
inline constexpr std::uint32_t kMakerInfo = 0x00A8;      // 48 bytes
inline constexpr std::uint32_t kSerial = 0x00D8;         // 16 bytes
inline constexpr std::uint32_t kUserName = 0x00E8;       // 16 bytes, writable
inline constexpr std::uint32_t kDiscoveryBytes = 0x00F8;
inline constexpr std::uint32_t kXmlUrl = 0x0200;  // 512 bytes
inline constexpr std::uint32_t kInterfaces = 0x0600;
inline constexpr std::uint32_t kMessageChannels = 0x0900;
inline constexpr std::uint32_t kStreamChannels = 0x0904;
inline constexpr std::uint32_t kCapability = 0x0934;
inline constexpr std::uint32_t kHeartbeatMs = 0x0938;
inline constexpr std::uint32_t kTickFrequency = 0x093C;  // 8 bytes
inline constexpr std::uint32_t kTimestampControl = 0x0944;
inline constexpr std::uint32_t kTimestamp = 0x0948;  // 8 bytes, as latched
inline constexpr std::uint32_t kControl = 0x0A00;
inline constexpr std::uint32_t kStreamPort = 0x0D00;
inline constexpr std::uint32_t kStreamPacketSize = 0x0D04;
inline constexpr std::uint32_t kStreamPacketDelay = 0x0D08;
inline constexpr std::uint32_t kStreamDestination = 0x0D18;
inline constexpr std::uint32_t kStreamSourcePort = 0x0D1C;

inline constexpr std::uint32_t kSensorWidth = 0xA000;
inline constexpr std::uint32_t kSensorHeight = 0xA004;
inline constexpr std::uint32_t kWidth = 0xA008;
inline constexpr std::uint32_t kHeight = 0xA00C;
inline constexpr std::uint32_t kOffsetX = 0xA010;
inline constexpr std::uint32_t kOffsetY = 0xA014;
inline constexpr std::uint32_t kPixelFormat = 0xA018;
inline constexpr std::uint32_t kPayloadSize = 0xA01C;
inline constexpr std::uint32_t kAcquisitionMode = 0xA020;
inline constexpr std::uint32_t kAcquisitionStart = 0xA024;
inline constexpr std::uint32_t kAcquisitionStop = 0xA028;
inline constexpr std::uint32_t kAcquisitionFrameCount = 0xA02C;
inline constexpr std::uint32_t kFrameRate = 0xA030;  // IEEE 754 single
inline constexpr std::uint32_t kChunkModeActive = 0xA040;
inline constexpr std::uint32_t kChunkSelector = 0xA044;
inline constexpr std::uint32_t kChunkEnable = 0xA048;  // one for each of kChunks
inline constexpr std::uint32_t kParametersLocked = 0xA060;
inline constexpr std::uint32_t kStreamMode = 0xA064;
inline constexpr std::uint32_t kExposureMapId = 0xA068;
inline constexpr std::uint32_t kSourceFrameCount = 0xA070;  // 8 bytes; 0 if not known
inline constexpr std::uint32_t kRegisterEnd = 0xA080;

inline constexpr std::uint32_t kXmlText = 0x00200000;
inline constexpr std::uint32_t kCodedHeader = 0x01000000;

// Bits of registers.
inline constexpr std::uint32_t kExclusiveControl = 1;
inline constexpr std::uint32_t kAnyControl = 3;
inline constexpr std::uint32_t kFireTestPacket = 0x80000000;
inline constexpr std::uint32_t kDoNotFragment = 0x40000000;
inline constexpr std::uint32_t kCanResend = 4;

// Limits for clients, so that none can block the camera or make it flood a network.
inline constexpr std::uint32_t kMinHeartbeatMs = 500;
inline constexpr std::uint32_t kMaxHeartbeatMs = 10'000;
inline constexpr std::uint32_t kMaxPacketDelayNs = 100'000'000;

// Values of kAcquisitionMode.
inline constexpr std::uint32_t kSingleFrame = 0;
inline constexpr std::uint32_t kMultiFrame = 1;
inline constexpr std::uint32_t kContinuous = 2;

/// What can follow an image in its payload.
struct Chunk {
    const char* name;  ///< in ChunkSelector; the feature is "Chunk" + name
    std::uint32_t id;  ///< on the wire
    std::uint32_t bytes;
};
inline constexpr std::uint32_t kImageChunkId = 0x1000;
inline constexpr Chunk kChunks[] = {
    {"Slot", 0x1001, 8}, {"ExposureMapID", 0x1002, 4}, {"Timestamp", 0x1003, 8}};
inline constexpr std::uint32_t kChunkTypes = 3;

}  // namespace stipple::gige
