#pragma once

#include <cstdint>
#include <string_view>

namespace stipple::u3v {

// Where the features of the description below lie.
constexpr std::uint64_t kWidth = 0x50000;
constexpr std::uint64_t kHeight = 0x50004;
constexpr std::uint64_t kPixelFormat = 0x50008;
constexpr std::uint64_t kPayloadSize = 0x5000C;
constexpr std::uint64_t kStart = 0x50010;
constexpr std::uint64_t kStop = 0x50014;
constexpr std::uint64_t kFrameRate = 0x50020;
constexpr std::uint64_t kExposureTime = 0x50028;
constexpr std::uint64_t kGain = 0x50030;
constexpr std::uint64_t kVendorName = 0x50100;
constexpr std::uint64_t kModelName = 0x50140;
constexpr std::uint64_t kSerialNumber = 0x50180;

/// The camera's GenICam description.
constexpr std::string_view kXml = R"(<?xml version="1.0" encoding="utf-8"?>
<RegisterDescription ModelName="Gadget" VendorName="Stipple" StandardNameSpace="None"
 SchemaMajorVersion="1" SchemaMinorVersion="1" SchemaSubMinorVersion="0" MajorVersion="1"
 MinorVersion="0" SubMinorVersion="0" ToolTip="USB3 Vision camera of the tests"
 ProductGuid="5f0c4d1e-0d0b-4d52-9c2e-6f6f53544950" VersionGuid="5f0c4d1e-0d0b-4d52-9c2e-6f6f53544951"
 xmlns="http://www.genicam.org/GenApi/Version_1_1">
<Category Name="Root"><pFeature>DeviceVendorName</pFeature><pFeature>DeviceModelName</pFeature>
<pFeature>DeviceSerialNumber</pFeature><pFeature>Width</pFeature><pFeature>Height</pFeature>
<pFeature>PixelFormat</pFeature><pFeature>PayloadSize</pFeature><pFeature>AcquisitionMode</pFeature>
<pFeature>AcquisitionFrameRate</pFeature><pFeature>ExposureTime</pFeature><pFeature>Gain</pFeature>
</Category>
<StringReg Name="DeviceVendorName"><Address>0x50100</Address><Length>64</Length>
<AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>
<StringReg Name="DeviceModelName"><Address>0x50140</Address><Length>64</Length>
<AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>
<StringReg Name="DeviceSerialNumber"><Address>0x50180</Address><Length>64</Length>
<AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>
<Integer Name="Width"><pValue>WidthReg</pValue><Min>4</Min><Max>4096</Max><Inc>4</Inc></Integer>
<IntReg Name="WidthReg"><Address>0x50000</Address><Length>4</Length><AccessMode>RW</AccessMode>
<pPort>Device</pPort><Cachable>NoCache</Cachable><Sign>Unsigned</Sign>
<Endianess>LittleEndian</Endianess></IntReg>
<Integer Name="Height"><pValue>HeightReg</pValue><Min>1</Min><Max>4096</Max></Integer>
<IntReg Name="HeightReg"><Address>0x50004</Address><Length>4</Length><AccessMode>RW</AccessMode>
<pPort>Device</pPort><Sign>Unsigned</Sign><Endianess>LittleEndian</Endianess></IntReg>
<Enumeration Name="PixelFormat">
<EnumEntry Name="Mono8"><Value>0x01080001</Value></EnumEntry>
<EnumEntry Name="Mono12p"><Value>0x010C0047</Value></EnumEntry>
<EnumEntry Name="Mono16"><Value>0x01100007</Value></EnumEntry>
<EnumEntry Name="RGB8"><Value>0x02180014</Value></EnumEntry>
<pValue>PixelFormatReg</pValue></Enumeration>
<IntReg Name="PixelFormatReg"><Address>0x50008</Address><Length>4</Length>
<AccessMode>RW</AccessMode><pPort>Device</pPort><Sign>Unsigned</Sign>
<Endianess>LittleEndian</Endianess></IntReg>
<Integer Name="PayloadSize"><pValue>PayloadSizeReg</pValue></Integer>
<IntReg Name="PayloadSizeReg"><Address>0x5000C</Address><Length>4</Length>
<AccessMode>RO</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable><Sign>Unsigned</Sign>
<Endianess>LittleEndian</Endianess></IntReg>
<Enumeration Name="AcquisitionMode">
<EnumEntry Name="Continuous"><Value>0</Value></EnumEntry><Value>0</Value></Enumeration>
<Command Name="AcquisitionStart"><pValue>StartReg</pValue><CommandValue>1</CommandValue></Command>
<IntReg Name="StartReg"><Address>0x50010</Address><Length>4</Length><AccessMode>WO</AccessMode>
<pPort>Device</pPort><Sign>Unsigned</Sign><Endianess>LittleEndian</Endianess></IntReg>
<Command Name="AcquisitionStop"><pValue>StopReg</pValue><CommandValue>1</CommandValue></Command>
<IntReg Name="StopReg"><Address>0x50014</Address><Length>4</Length><AccessMode>WO</AccessMode>
<pPort>Device</pPort><Sign>Unsigned</Sign><Endianess>LittleEndian</Endianess></IntReg>
<Float Name="AcquisitionFrameRate"><pValue>FrameRateReg</pValue><Min>1</Min><Max>1000</Max></Float>
<FloatReg Name="FrameRateReg"><Address>0x50020</Address><Length>8</Length>
<AccessMode>RW</AccessMode><pPort>Device</pPort><Endianess>LittleEndian</Endianess></FloatReg>
<Float Name="ExposureTime"><pValue>ExposureReg</pValue><Min>10</Min><Max>1000000</Max></Float>
<FloatReg Name="ExposureReg"><Address>0x50028</Address><Length>8</Length>
<AccessMode>RW</AccessMode><pPort>Device</pPort><Endianess>LittleEndian</Endianess></FloatReg>
<Float Name="Gain"><pValue>GainReg</pValue><Min>0</Min><Max>24</Max></Float>
<FloatReg Name="GainReg"><Address>0x50030</Address><Length>8</Length>
<AccessMode>RW</AccessMode><pPort>Device</pPort><Endianess>LittleEndian</Endianess></FloatReg>
<Port Name="Device"/>
</RegisterDescription>
)";

}  // namespace stipple::u3v
