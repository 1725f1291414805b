#pragma once

#include <gtest/gtest.h>
#include <poll.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "capture/serve/big_endian.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/udp_socket.h"

namespace stipple {

/// What came back to a command.
struct GvcpAnswer {
    std::uint16_t status = 0;
    std::vector<std::uint8_t> content;
};

/// A client on plain sockets, which knows of the protocol only what a test tells it.
class GigeClient {
  public:
    GigeClient(std::uint32_t camera, std::uint32_t own = 0x7F000001)
        : camera_{camera, kGvcpPort}, control_({own, 0}), data_({own, 0}) {}

    /// Waits for the answer; asks again, as any client must over UDP.
    std::optional<GvcpAnswer> ask(GvcpCode code, const std::vector<std::uint8_t>& content) {
        ++id_;
        for (int attempt = 0; attempt < 50; ++attempt) {
            control_.send(camera_, encode_gvcp_command(code, id_, content));
            while (const auto reply = wait(control_, 200)) {
                const auto& bytes = reply->bytes;
                if (bytes.size() < 8 || load_be<std::uint16_t>(&bytes[6]) != id_) continue;
                return GvcpAnswer{load_be<std::uint16_t>(bytes.data()),
                                  {bytes.begin() + 8, bytes.end()}};
            }
        }
        return {};
    }

    /// Sends without waiting for an answer.
    void tell(GvcpCode code, const std::vector<std::uint8_t>& content) {
        control_.send(camera_, encode_gvcp_command(code, ++id_, content));
    }

    std::optional<std::uint32_t> read(std::uint32_t address) {
        const auto answer = ask(GvcpCode::kReadRegister, words({address}));
        if (!answer || answer->status != 0 || answer->content.size() != 4) return {};
        return load_be<std::uint32_t>(answer->content.data());
    }

    /// The status, or nothing without an answer.
    std::optional<std::uint16_t> write(std::uint32_t address, std::uint32_t value) {
        const auto answer = ask(GvcpCode::kWriteRegister, words({address, value}));
        if (!answer) return {};
        return answer->status;
    }

    /// The next packet of the stream, or nothing.
    std::optional<Datagram> packet(int timeout_ms = 5000) { return wait(data_, timeout_ms); }

    [[nodiscard]] std::uint16_t data_port() const { return data_.local().port; }
    [[nodiscard]] const UdpSocket& data() const { return data_; }

    static std::vector<std::uint8_t> words(const std::vector<std::uint32_t>& values) {
        std::vector<std::uint8_t> bytes;
        for (const std::uint32_t value : values) append_be(bytes, value);
        return bytes;
    }

  private:
    static std::optional<Datagram> wait(const UdpSocket& socket, int timeout_ms) {
        pollfd readable{socket.descriptor(), POLLIN, 0};
        if (poll(&readable, 1, timeout_ms) <= 0) return {};
        return socket.receive();
    }

    UdpEndpoint camera_;
    UdpSocket control_;
    UdpSocket data_;
    std::uint16_t id_ = 0;
};

}  // namespace stipple
