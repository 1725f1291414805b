#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "capture/serve/frame_source.h"
#include "capture/serve/gvsp_faults.h"

namespace stipple {

struct GigeServerOptions {
    std::string address = "127.0.0.1";  ///< IPv4, of this machine
    std::string model = "Recording";
    std::string version = {};
    std::string serial = {};  ///< empty: the address
    bool repeat = false;      ///< start again at the end of the source
    bool can_resend = true;
    bool allow_other_destination = false;  ///< false: only to the address of the client
    GvspFaults faults = {};
};

struct GigeServerCounts {
    std::uint64_t frames = 0;
    std::uint64_t late_frames = 0;  ///< sent more than one frame period late
    std::uint64_t packets = 0;
    std::uint64_t packets_resent = 0;
    std::uint64_t starts = 0;
};

/// Offers a source of frames as a GigE Vision camera on an address of this machine: discovery,
/// registers and GenICam XML, control privilege and heartbeat, streaming with packet resend and
/// chunk data.
///
/// Not implemented: events, triggers, PTP, multicast, more than one stream channel, block ids of 64
/// bits, FORCEIP.
class GigeServer {
  public:
    /// Binds the address. Clients are answered while `run` runs. `source` must outlive the server.
    /// \throws InputError if the address is none, DeviceError if it cannot be bound.
    GigeServer(FrameSource& source, const GigeServerOptions& options);
    ~GigeServer();
    GigeServer(const GigeServer&) = delete;
    GigeServer& operator=(const GigeServer&) = delete;

    /// Serves until `stop` returns true; it is called at least every 100 ms.
    /// \throws InputError if a frame of the source cannot be read.
    void run(const std::function<bool()>& stop);

    [[nodiscard]] GigeServerCounts counts() const;
    /// The controlling client, as "10.0.0.5:40112"; empty if there is none.
    [[nodiscard]] std::string client() const;
    [[nodiscard]] const std::string& xml() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
