#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "capture/serve/frame_source.h"
#include "capture/serve/gige_registers.h"
#include "capture/serve/gvcp_codec.h"
#include "capture/serve/udp_socket.h"

namespace stipple {

/// Identity of a served camera. Addresses in host byte order.
struct GigeIdentity {
    std::uint32_t address = 0x7F000001;
    std::uint32_t netmask = 0xFF000000;
    std::uint64_t mac = 0x020000000000;
    std::string model = "Recording";
    std::string version;
    std::string serial;
    bool can_resend = true;
    bool allow_other_destination = false;  ///< false: only to the address of the controller
};

/// Settings of the stream in the registers.
struct GigeStreamSettings {
    bool running = false;
    std::uint64_t starts = 0;  ///< AcquisitionStart commands so far
    UdpEndpoint destination;   ///< address or port 0: no receiver
    std::size_t packet_bytes = 0;
    bool do_not_fragment = false;
    std::chrono::nanoseconds packet_delay{0};
    const PixelFormat* format = nullptr;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t offset_x = 0;
    std::uint32_t offset_y = 0;
    double frames_hz = 0;
    std::optional<std::uint64_t> frames;  ///< requested number; empty: until stopped
    bool chunk_mode = false;
    std::array<bool, gige::kChunkTypes> chunks = {};
};

/// Result of a command.
struct GigeOutcome {
    std::vector<std::uint8_t> reply;  ///< empty: none
    std::optional<GvcpPacketResend> resend;
    bool fire_test_packet = false;
};

/// The control side of a GigE Vision camera: registers, XML, control privilege, heartbeat. Without
/// sockets, threads and clock.
class GigeDevice {
  public:
    /// Time of any monotonic clock; the device time counts from its epoch.
    using Time = std::chrono::nanoseconds;

    GigeDevice(const GigeIdentity& identity, const ServedImage& image);

    /// Executes a command.
    [[nodiscard]] GigeOutcome execute(const GvcpCommand& command, UdpEndpoint peer, Time now);
    /// If the controller has been silent for the heartbeat timeout, removes its control and ends
    /// its stream. Returns whether it did.
    bool check_heartbeat(Time now);
    /// Time at which the heartbeat timeout expires; empty without a controller.
    [[nodiscard]] std::optional<Time> heartbeat_due() const;
    /// The stream number `starts` has ended by itself; ignored if another one has begun.
    void stream_ended(std::uint64_t starts);

    [[nodiscard]] GigeStreamSettings stream() const;
    [[nodiscard]] std::optional<UdpEndpoint> controller() const { return controller_; }
    [[nodiscard]] std::uint32_t word(std::uint32_t address) const;
    [[nodiscard]] const std::string& xml() const { return xml_; }

  private:
    struct Reply {
        GvcpStatus status = GvcpStatus::kSuccess;
        std::vector<std::uint8_t> content;
    };

    void fill_bootstrap(const GigeIdentity& identity);
    void fill_features();
    void set_word(std::uint32_t address, std::uint32_t value);
    void set_text(std::uint32_t address, const std::string& text, std::size_t bytes);
    void update_payload_size();
    void stop();
    void release();

    [[nodiscard]] bool read(std::uint32_t address, std::size_t bytes,
                            std::vector<std::uint8_t>& to) const;
    [[nodiscard]] bool is_controller(UdpEndpoint peer) const { return controller_ == peer; }
    [[nodiscard]] bool may_resend(UdpEndpoint peer) const;
    [[nodiscard]] bool may_read(UdpEndpoint peer, std::uint32_t address) const;
    [[nodiscard]] GvcpStatus write(std::uint32_t address, std::uint32_t value, UdpEndpoint peer,
                                   Time now);
    [[nodiscard]] GvcpStatus write_control(std::uint32_t value, UdpEndpoint peer, Time now);
    [[nodiscard]] GvcpStatus write_feature(std::uint32_t address, std::uint32_t value);
    [[nodiscard]] GvcpStatus check_write(std::uint32_t address, std::uint32_t value) const;
    [[nodiscard]] bool fits_region(std::uint32_t address, std::uint32_t value) const;

    Reply on(const GvcpDiscovery& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpReadRegisters& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpWriteRegisters& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpReadMemory& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpWriteMemory& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpPacketResend& command, UdpEndpoint peer, Time now);
    Reply on(const GvcpRefused& command, UdpEndpoint peer, Time now);

    ServedImage image_;
    bool allow_other_destination_ = false;
    std::string xml_;
    std::vector<std::uint8_t> registers_;
    std::optional<UdpEndpoint> controller_;
    Time last_heard_{0};
    bool running_ = false;
    bool fire_test_packet_ = false;
    std::uint64_t starts_ = 0;
};

}  // namespace stipple
