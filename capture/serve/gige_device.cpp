#include "capture/serve/gige_device.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "capture/serve/big_endian.h"
#include "capture/serve/gige_xml.h"

namespace stipple {
namespace {

void append(std::vector<std::uint8_t>& to, const std::string& text, std::size_t from,
            std::size_t bytes) {
    for (std::size_t i = from; i < from + bytes; ++i)
        to.push_back(i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0);
}

/// Bytes of a read-only text in memory: with its end, in whole words.
std::size_t text_bytes(const std::string& text) {
    return text.size() / 4 * 4 + 4;
}

}  // namespace

GigeDevice::GigeDevice(const GigeIdentity& identity, const ServedImage& image)
    : image_(image),
      allow_other_destination_(identity.allow_other_destination),
      xml_(gige_xml(image)),
      registers_(gige::kRegisterEnd) {
    fill_bootstrap(identity);
    fill_features();
}

GigeOutcome GigeDevice::execute(const GvcpCommand& command, UdpEndpoint peer, Time now) {
    static_cast<void>(check_heartbeat(now));
    if (is_controller(peer)) last_heard_ = now;
    GigeOutcome outcome;
    if (const auto* resend = std::get_if<GvcpPacketResend>(&command.body)) {
        if (may_resend(peer) && resend->channel == 0) outcome.resend = *resend;
        return outcome;
    }
    const Reply reply =
        std::visit([&](const auto& body) { return on(body, peer, now); }, command.body);
    if (command.wants_reply)
        outcome.reply = encode_gvcp_reply(command, reply.status, reply.content);
    outcome.fire_test_packet = std::exchange(fire_test_packet_, false);
    return outcome;
}

bool GigeDevice::check_heartbeat(Time now) {
    const auto due = heartbeat_due();
    if (!due || now < *due) return false;
    release();
    return true;
}

std::optional<GigeDevice::Time> GigeDevice::heartbeat_due() const {
    if (!controller_) return {};
    return last_heard_ + std::chrono::milliseconds(word(gige::kHeartbeatMs));
}

void GigeDevice::stream_ended(std::uint64_t starts) {
    if (starts == starts_) stop();
}

void GigeDevice::stop() {
    running_ = false;
    set_word(gige::kParametersLocked, 0);
}

void GigeDevice::release() {
    controller_.reset();
    set_word(gige::kControl, 0);
    set_word(gige::kStreamPort, 0);
    set_word(gige::kStreamDestination, 0);
    stop();
}

bool GigeDevice::read(std::uint32_t address, std::size_t bytes,
                      std::vector<std::uint8_t>& to) const {
    if (address < registers_.size() && bytes <= registers_.size() - address) {
        const auto from = registers_.begin() + address;
        to.insert(to.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
        return true;
    }
    const auto read_text = [&](std::uint32_t start, const std::string& text) {
        const std::size_t size = text_bytes(text);
        if (address < start || address - start >= size || bytes > size - (address - start))
            return false;
        append(to, text, address - start, bytes);
        return true;
    };
    return read_text(gige::kXmlText, xml_) ||
           (!image_.coded_header.empty() && read_text(gige::kCodedHeader, image_.coded_header));
}

/// Clients ask from the port of their commands or from that of their stream.
bool GigeDevice::may_resend(UdpEndpoint peer) const {
    const bool can = (word(gige::kCapability) & gige::kCanResend) != 0;
    return can && controller_ && (is_controller(peer) || peer == stream().destination);
}

bool GigeDevice::may_read(UdpEndpoint peer, std::uint32_t address) const {
    const bool exclusive = (word(gige::kControl) & gige::kExclusiveControl) != 0;
    return !exclusive || is_controller(peer) || address == gige::kControl;
}

GigeDevice::Reply GigeDevice::on(const GvcpDiscovery&, UdpEndpoint, Time) {
    Reply reply;
    static_cast<void>(read(0, gige::kDiscoveryBytes, reply.content));
    return reply;
}

GigeDevice::Reply GigeDevice::on(const GvcpReadRegisters& command, UdpEndpoint peer, Time) {
    Reply reply;
    for (const std::uint32_t address : command.addresses) {
        if (address % 4 != 0) return {GvcpStatus::kBadAlignment, {}};
        if (!may_read(peer, address)) return {GvcpStatus::kAccessDenied, {}};
        if (!read(address, 4, reply.content)) return {GvcpStatus::kInvalidAddress, {}};
    }
    return reply;
}

GigeDevice::Reply GigeDevice::on(const GvcpWriteRegisters& command, UdpEndpoint peer, Time now) {
    Reply reply{GvcpStatus::kSuccess, {0, 0}};
    std::uint16_t done = 0;
    for (const auto& [address, value] : command.writes) {
        reply.status = write(address, value, peer, now);
        if (reply.status != GvcpStatus::kSuccess) break;
        ++done;
    }
    append_be(reply.content, static_cast<std::uint16_t>(done));
    return reply;
}

GigeDevice::Reply GigeDevice::on(const GvcpReadMemory& command, UdpEndpoint peer, Time) {
    if (command.address % 4 != 0) return {GvcpStatus::kBadAlignment, {}};
    if (!may_read(peer, command.address)) return {GvcpStatus::kAccessDenied, {}};
    Reply reply;
    append_be(reply.content, command.address);
    if (!read(command.address, command.bytes, reply.content))
        return {GvcpStatus::kInvalidAddress, {}};
    return reply;
}

GigeDevice::Reply GigeDevice::on(const GvcpWriteMemory& command, UdpEndpoint peer, Time now) {
    Reply reply{GvcpStatus::kSuccess, {0, 0}};
    std::size_t done = 0;
    for (; done < command.data.size(); done += 4) {
        const auto value = load_be<std::uint32_t>(&command.data[done]);
        reply.status = write(command.address + static_cast<std::uint32_t>(done), value, peer, now);
        if (reply.status != GvcpStatus::kSuccess) break;
    }
    append_be(reply.content, static_cast<std::uint16_t>(done));
    return reply;
}

GigeDevice::Reply GigeDevice::on(const GvcpPacketResend&, UdpEndpoint, Time) {
    return {};  // has no reply
}

GigeDevice::Reply GigeDevice::on(const GvcpRefused& command, UdpEndpoint, Time) {
    return {command.status, {}};
}

GvcpStatus GigeDevice::write(std::uint32_t address, std::uint32_t value, UdpEndpoint peer,
                             Time now) {
    if (address % 4 != 0) return GvcpStatus::kBadAlignment;
    if (address == gige::kControl) return write_control(value, peer, now);
    if (!is_controller(peer)) return GvcpStatus::kAccessDenied;
    if (address == gige::kTimestampControl) {
        const auto ticks = static_cast<std::uint64_t>(now.count());
        set_word(gige::kTimestamp, static_cast<std::uint32_t>(ticks >> 32U));
        set_word(gige::kTimestamp + 4, static_cast<std::uint32_t>(ticks));
        return GvcpStatus::kSuccess;
    }
    return write_feature(address, value);
}

GvcpStatus GigeDevice::write_control(std::uint32_t value, UdpEndpoint peer, Time now) {
    if (controller_ && !is_controller(peer)) return GvcpStatus::kAccessDenied;
    if ((value & gige::kAnyControl) == 0) {
        if (controller_) release();
        return GvcpStatus::kSuccess;
    }
    controller_ = peer;
    last_heard_ = now;
    set_word(gige::kControl, value & gige::kAnyControl);
    return GvcpStatus::kSuccess;
}

GvcpStatus GigeDevice::write_feature(std::uint32_t address, std::uint32_t value) {
    if (address >= registers_.size())
        return address < gige::kXmlText ? GvcpStatus::kInvalidAddress : GvcpStatus::kWriteProtect;
    switch (address) {
        case gige::kAcquisitionStart:
            if (running_) return GvcpStatus::kSuccess;
            running_ = true;
            ++starts_;
            set_word(gige::kParametersLocked, 1);
            return GvcpStatus::kSuccess;
        case gige::kAcquisitionStop:
            stop();
            return GvcpStatus::kSuccess;
        case gige::kHeartbeatMs:
            value = std::clamp(value, gige::kMinHeartbeatMs, gige::kMaxHeartbeatMs);
            break;
        case gige::kStreamPacketSize:
            fire_test_packet_ = (value & gige::kFireTestPacket) != 0;
            value &= ~gige::kFireTestPacket & ~3U;
            break;
        default:
            break;
    }
    const bool of_stream = address >= gige::kSensorWidth && address != gige::kChunkSelector;
    if (of_stream && running_ && address <= gige::kChunkEnable + 4 * (gige::kChunkTypes - 1))
        return GvcpStatus::kBusy;
    if (const GvcpStatus status = check_write(address, value); status != GvcpStatus::kSuccess)
        return status;
    set_word(address, value);
    update_payload_size();
    return GvcpStatus::kSuccess;
}

}  // namespace stipple
