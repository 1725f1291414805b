#include "tests/vm/functionfs.h"

#include <fcntl.h>
#include <linux/usb/functionfs.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <initializer_list>
#include <system_error>
#include <vector>

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kController = "dummy_udc.0";
const fs::path kGadgets = "/sys/kernel/config/usb_gadget";
const fs::path kEndpoints = "/run/usb3_vision";

constexpr int kMiscellaneous = 0xEF;
constexpr int kUsb3Vision = 0x05;
constexpr int kSuperSpeedPacket = 1024;

void check(bool good, const std::string& what) {
    if (!good) throw std::system_error(errno, std::generic_category(), what);
}

void set(const fs::path& file, const std::string& value) {
    std::ofstream out(file);
    out << value << '\n' << std::flush;
    check(out.good(), file.string());
}

void append(Bytes& bytes, std::uint32_t value) {
    for (int i = 0; i < 4; ++i, value >>= 8U) bytes.push_back(static_cast<std::uint8_t>(value));
}

void append_bytes(Bytes& bytes, std::initializer_list<int> more) {
    for (const int byte : more) bytes.push_back(static_cast<std::uint8_t>(byte));
}

/// Interfaces and endpoints for packets of that size.
Bytes descriptors(int packet_bytes) {
    Bytes bytes;
    const auto interface = [&](int number, int endpoints, int device, int kind, int protocol) {
        append_bytes(bytes, {USB_DT_INTERFACE_SIZE, USB_DT_INTERFACE, number, 0, endpoints, device,
                             kind, protocol, 0});
    };
    const auto endpoint = [&](int address) {
        append_bytes(bytes, {USB_DT_ENDPOINT_SIZE, USB_DT_ENDPOINT, address, USB_ENDPOINT_XFER_BULK,
                             packet_bytes % 256, packet_bytes / 256, 0});
        if (packet_bytes == kSuperSpeedPacket)
            append_bytes(bytes, {USB_DT_SS_EP_COMP_SIZE, USB_DT_SS_ENDPOINT_COMP, 0, 0, 0, 0});
    };
    // Aravis takes the two directions of control to have the same number. The controller gives
    // numbers out in order: three endpoints that nobody uses make both of them 1.
    interface(0, 3, 0xFF, 0, 0);
    for (const int unused : {1, 2, 3}) endpoint(unused);
    interface(1, 2, kMiscellaneous, kUsb3Vision, 0);
    endpoint(0x84);
    endpoint(5);
    interface(2, 1, kMiscellaneous, kUsb3Vision, 2);
    endpoint(0x86);
    return bytes;
}

/// What is first written to endpoint 0: the descriptors of the three speeds.
Bytes all_descriptors() {
    const Bytes full = descriptors(64);
    const Bytes high = descriptors(512);
    const Bytes super = descriptors(kSuperSpeedPacket);
    Bytes bytes;
    append(bytes, FUNCTIONFS_DESCRIPTORS_MAGIC_V2);
    append(bytes, static_cast<std::uint32_t>(24 + full.size() + high.size() + super.size()));
    append(bytes, FUNCTIONFS_HAS_FS_DESC | FUNCTIONFS_HAS_HS_DESC | FUNCTIONFS_HAS_SS_DESC);
    for (const std::uint32_t count : {9U, 9U, 15U}) append(bytes, count);
    for (const Bytes* speed : {&full, &high, &super})
        bytes.insert(bytes.end(), speed->begin(), speed->end());
    return bytes;
}

Bytes no_strings() {
    Bytes bytes;
    append(bytes, FUNCTIONFS_STRINGS_MAGIC);
    for (const std::uint32_t value : {16U, 0U, 0U}) append(bytes, value);
    return bytes;
}

void write_all(int descriptor, const Bytes& bytes, const char* what) {
    check(::write(descriptor, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
          what);
}

int open_endpoint(int number) {
    const fs::path file = kEndpoints / ("ep" + std::to_string(number));
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
    check(descriptor >= 0, file.string());
    return descriptor;
}

}  // namespace

FunctionFs::FunctionFs(const std::string& serial) : gadget_(kGadgets / "camera") {
    if (!fs::exists(kGadgets))
        check(::mount("none", "/sys/kernel/config", "configfs", 0, nullptr) == 0, "configfs");
    for (const char* folder : {"", "strings/0x409", "configs/c.1", "functions/ffs.camera"})
        fs::create_directories(gadget_ / folder);
    for (const auto& [key, value] : std::initializer_list<std::pair<const char*, std::string>>{
             {"idVendor", "0x1209"},
             {"idProduct", "0x0001"},
             {"bDeviceClass", "0xEF"},
             {"bDeviceSubClass", "2"},
             {"bDeviceProtocol", "1"},
             {"bcdUSB", "0x0310"},
             {"strings/0x409/manufacturer", "Stipple"},
             {"strings/0x409/product", "Gadget"},
             {"strings/0x409/serialnumber", serial}})
        set(gadget_ / key, value);
    fs::create_symlink(gadget_ / "functions/ffs.camera", gadget_ / "configs/c.1/ffs.camera");
    fs::create_directories(kEndpoints);
    check(::mount("camera", kEndpoints.c_str(), "functionfs", 0, nullptr) == 0, "functionfs");
    control_ = open_endpoint(0);
    write_all(control_, all_descriptors(), "descriptors");
    write_all(control_, no_strings(), "strings");
    answers_ = open_endpoint(4);
    requests_ = open_endpoint(5);
    stream_ = open_endpoint(6);
}

void FunctionFs::plug() const {
    set(gadget_ / "UDC", kController);
}

void FunctionFs::unplug() const {
    set(gadget_ / "UDC", "");
}

std::size_t FunctionFs::read_request(std::span<std::uint8_t> buffer) const {
    const ssize_t size = ::read(requests_, buffer.data(), buffer.size());
    return size < 0 ? 0 : static_cast<std::size_t>(size);
}

void FunctionFs::write_answer(std::span<const std::uint8_t> bytes) const {
    // Fails where the host has unplugged the camera: nobody waits for the answer then.
    [[maybe_unused]] const ssize_t size = ::write(answers_, bytes.data(), bytes.size());
}

bool FunctionFs::write_stream(std::span<const std::uint8_t> bytes) const {
    return ::write(stream_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
}

void FunctionFs::wait_for_disconnection() const {
    for (;;) {
        usb_functionfs_event event{};
        if (::read(control_, &event, sizeof event) != static_cast<ssize_t>(sizeof event)) continue;
        if (event.type == FUNCTIONFS_DISABLE || event.type == FUNCTIONFS_UNBIND) return;
    }
}

}  // namespace stipple
