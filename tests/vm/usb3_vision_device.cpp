#include "tests/vm/usb3_vision_device.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "tests/capture/fake_frame.h"
#include "tests/vm/usb3_vision_xml.h"

namespace stipple {
namespace {

using Bytes = std::vector<std::uint8_t>;

// GenCP: "U3VC", then flags or status, command, size of the rest, number of the request.
constexpr std::uint32_t kControlMagic = 0x43563355;
constexpr std::size_t kControlHeaderBytes = 12;
constexpr std::uint16_t kReadMemory = 0x0800;
constexpr std::uint16_t kWriteMemory = 0x0802;
constexpr std::uint16_t kInvalidAddress = 0x8003;

// The stream: "U3VL" and "U3VT".
constexpr std::uint32_t kLeaderMagic = 0x4C563355;
constexpr std::uint32_t kTrailerMagic = 0x54563355;
constexpr std::uint16_t kLeaderBytes = 52;
constexpr std::uint16_t kTrailerBytes = 28;
constexpr std::uint16_t kImage = 1;

// Bootstrap registers: of all of GenCP, of USB3 Vision (SBRM), of its stream (SIRM), the table of
// descriptions and the description.
constexpr std::uint64_t kSbrm = 0x10000;
constexpr std::uint64_t kSirm = 0x20000;
constexpr std::uint64_t kManifest = 0x30000;
constexpr std::uint64_t kXmlAddress = 0x60000;
constexpr std::uint64_t kStreamControl = kSirm + 0x04;
constexpr std::uint64_t kRequiredPayloadBytes = kSirm + 0x08;
constexpr std::size_t kMemoryBytes = 0x70000;

std::uint64_t load(std::span<const std::uint8_t> bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | bytes[i];
    return value;
}

void append(Bytes& bytes, std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i, value >>= 8U) bytes.push_back(static_cast<std::uint8_t>(value));
}

}  // namespace

Usb3VisionDevice::Usb3VisionDevice(const std::string& serial) : memory_(kMemoryBytes) {
    place(0x0000, 0x00010001, 4);  // GenCP 1.1
    place(0x0004, "Stipple");
    place(0x0044, "Gadget");
    place(0x0144, serial);
    place(0x01CC, 500, 4);  // ms to answer
    place(0x01D0, kManifest, 8);
    place(0x01D8, kSbrm, 8);

    place(kSbrm, 0x00010000, 4);  // USB3 Vision 1.0
    place(kSbrm + 0x04, 1, 8);    // a stream
    place(kSbrm + 0x14, 1024, 4);
    place(kSbrm + 0x18, 1024, 4);
    place(kSbrm + 0x1C, 1, 4);
    place(kSbrm + 0x20, kSirm, 8);
    place(kSbrm + 0x28, 0x30, 4);

    place(kSirm, 10U << 24U, 4);  // transfers in multiples of 1024 bytes
    place(kSirm + 0x10, kLeaderBytes, 4);
    place(kSirm + 0x14, kTrailerBytes, 4);

    place(kManifest, 1, 8);  // entries
    place(kManifest + 0x08, 0x01000000, 4);
    place(kManifest + 0x0C, 0, 4);  // XML, not zipped
    place(kManifest + 0x10, kXmlAddress, 8);
    place(kManifest + 0x18, u3v::kXml.size(), 8);
    place(kXmlAddress, std::string(u3v::kXml));

    place(u3v::kVendorName, "Stipple");
    place(u3v::kModelName, "Gadget");
    place(u3v::kSerialNumber, serial);
    place(u3v::kWidth, 160, 4);
    place(u3v::kHeight, 120, 4);
    place(u3v::kPixelFormat, 0x01080001, 4);
    place(u3v::kFrameRate, 20.0);
    place(u3v::kExposureTime, 5000.0);
    place(u3v::kGain, 0.0);
    written(u3v::kWidth);
}

void Usb3VisionDevice::place(std::uint64_t address, std::uint64_t value, int bytes) {
    for (int i = 0; i < bytes; ++i, value >>= 8U) memory_[address++] = value & 0xFFU;
}

void Usb3VisionDevice::place(std::uint64_t address, const std::string& text) {
    std::copy(text.begin(), text.end(), memory_.begin() + static_cast<std::ptrdiff_t>(address));
}

void Usb3VisionDevice::place(std::uint64_t address, double value) {
    place(address, std::bit_cast<std::uint64_t>(value), 8);
}

std::uint64_t Usb3VisionDevice::value_at(std::uint64_t address, int bytes) const {
    return load(std::span(memory_).subspan(address, static_cast<std::size_t>(bytes)));
}

bool Usb3VisionDevice::has(std::uint64_t address, std::size_t bytes) const {
    return address < memory_.size() && bytes <= memory_.size() - address;
}

std::size_t Usb3VisionDevice::frame_bytes() const {
    const std::uint64_t bits_per_pixel = value_at(u3v::kPixelFormat, 4) >> 16U & 0xFFU;  // PFNC
    return value_at(u3v::kWidth, 4) * value_at(u3v::kHeight, 4) * bits_per_pixel / 8;
}

/// What the host has set the transfers of a frame to.
std::size_t Usb3VisionDevice::transfer_bytes() const {
    return value_at(kSirm + 0x1C, 4) * value_at(kSirm + 0x20, 4) + value_at(kSirm + 0x24, 4) +
           value_at(kSirm + 0x28, 4);
}

/// What follows from a register that was written.
void Usb3VisionDevice::written(std::uint64_t address) {
    place(u3v::kPayloadSize, frame_bytes(), 4);
    place(kRequiredPayloadBytes, frame_bytes(), 8);
    if (address == u3v::kStart) {
        acquiring_ = true;
        next_id_ = 0;
    }
    if (address == u3v::kStop) acquiring_ = false;
}

std::vector<std::uint8_t> Usb3VisionDevice::answer(std::span<const std::uint8_t> request) {
    const std::scoped_lock lock(mutex_);
    if (request.size() < kControlHeaderBytes + 8 || load(request.first(4)) != kControlMagic)
        return {};
    const auto command = load(request.subspan(6, 2));
    const std::uint64_t address = load(request.subspan(12, 8));
    const auto rest = request.subspan(kControlHeaderBytes + 8);
    Bytes data;
    std::uint16_t status = 0;
    if (command == kReadMemory && rest.size() >= 4) {
        const std::size_t bytes = load(rest.subspan(2, 2));
        if (!has(address, bytes)) status = kInvalidAddress;
        const auto begin = memory_.begin() + static_cast<std::ptrdiff_t>(address);
        if (status == 0) data.assign(begin, begin + static_cast<std::ptrdiff_t>(bytes));
    } else if (command == kWriteMemory) {
        if (!has(address, rest.size())) status = kInvalidAddress;
        if (status == 0) {
            std::copy(rest.begin(), rest.end(),
                      memory_.begin() + static_cast<std::ptrdiff_t>(address));
            written(address);
        }
        append(data, 0, 2);
        append(data, status == 0 ? rest.size() : 0, 2);
    } else {
        return {};
    }
    Bytes bytes;
    append(bytes, kControlMagic, 4);
    append(bytes, status, 2);
    append(bytes, command + 1, 2);
    append(bytes, data.size(), 2);
    append(bytes, load(request.subspan(10, 2)), 2);
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

bool Usb3VisionDevice::is_streaming() const {
    const std::scoped_lock lock(mutex_);
    return acquiring_ && (value_at(kStreamControl, 4) & 1U) != 0;
}

double Usb3VisionDevice::frame_rate_hz() const {
    const std::scoped_lock lock(mutex_);
    return std::bit_cast<double>(value_at(u3v::kFrameRate, 8));
}

Usb3VisionDevice::Block Usb3VisionDevice::next_block() {
    const std::scoped_lock lock(mutex_);
    next_id_ += std::exchange(skipped_, 0);
    const std::uint64_t id = next_id_++;
    Block block;
    append(block.leader, kLeaderMagic, 4);
    append(block.leader, 0, 2);
    append(block.leader, kLeaderBytes, 2);
    append(block.leader, id, 8);
    append(block.leader, 0, 2);
    append(block.leader, kImage, 2);
    append(block.leader, fake_stamp_ns(id), 8);
    for (const auto feature : {u3v::kPixelFormat, u3v::kWidth, u3v::kHeight})
        append(block.leader, value_at(feature, 4), 4);
    append(block.leader, 0, 12);  // offsets, padding

    block.payload.resize(frame_bytes());
    fill_fake_frame(block.payload, id);
    const std::size_t most = std::min(transfer_bytes(), std::exchange(max_bytes_, ~std::size_t{0}));
    block.payload.resize(std::min(block.payload.size(), most));

    if (std::exchange(loses_trailer_, false)) return block;
    append(block.trailer, kTrailerMagic, 4);
    append(block.trailer, 0, 2);
    append(block.trailer, kTrailerBytes, 2);
    append(block.trailer, id, 8);
    append(block.trailer, 0, 4);
    append(block.trailer, block.payload.size(), 8);
    return block;
}

void Usb3VisionDevice::stop_streaming() {
    const std::scoped_lock lock(mutex_);
    acquiring_ = false;
    place(kStreamControl, 0, 4);
}

void Usb3VisionDevice::skip(std::uint64_t frames) {
    const std::scoped_lock lock(mutex_);
    skipped_ += frames;
}

void Usb3VisionDevice::cut(std::size_t bytes) {
    const std::scoped_lock lock(mutex_);
    max_bytes_ = bytes;
}

void Usb3VisionDevice::lose_trailer() {
    const std::scoped_lock lock(mutex_);
    loses_trailer_ = true;
}

void Usb3VisionDevice::set_width(std::uint32_t width) {
    const std::scoped_lock lock(mutex_);
    place(u3v::kWidth, width, 4);
    written(u3v::kWidth);
}

}  // namespace stipple
