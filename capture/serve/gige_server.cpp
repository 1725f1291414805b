#include "capture/serve/gige_server.h"

#include <fmt/format.h>
#include <poll.h>

#include <atomic>
#include <cerrno>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "capture/network.h"
#include "capture/serve/gige_device.h"
#include "capture/serve/gvsp_sender.h"
#include "capture/serve/udp_socket.h"
#include "core/error.h"

namespace stipple {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::nanoseconds;

constexpr int kPollMs = 100;
constexpr int kSendBufferBytes = 8 << 20;
constexpr std::uint32_t kLimitedBroadcast = 0xFFFFFFFF;
/// Begin of a MAC address that is given out locally, not by a maker; the IPv4 address follows.
constexpr std::uint64_t kLocalMac = 0x0253;
/// A stream that is late by more is not hurried: its due times move on.
constexpr int kMaxPeriodsBehind = 8;

std::uint32_t address_of(const GigeServerOptions& options) {
    const auto address = parse_ipv4(options.address);
    if (address) return *address;
    throw InputError(Parameter{"address", options.address},
                     "is not an IPv4 address such as 127.0.0.1");
}

NetworkInterface own_interface(std::uint32_t address) {
    if (const auto interface = interface_at(address)) return *interface;
    throw DeviceError(ipv4_text(address),
                      "no network interface of this machine has such an address; \"ip address\" "
                      "lists those it has");
}

UdpSocket control_socket(std::uint32_t address) {
    try {
        return UdpSocket({address, kGvcpPort});
    } catch (const std::system_error& e) {
        const bool taken = e.code().value() == EADDRINUSE;
        throw DeviceError(
            fmt::format("{}: UDP port {}", ipv4_text(address), kGvcpPort),
            taken ? "is taken: another camera is served at this address; choose another " +
                        Parameter{"address"}
                  : Message(e.what()));
    }
}

bool is_loopback(std::uint32_t address) {
    return address >> 24U == 127;
}

/// A device time: nanoseconds of the steady clock.
nanoseconds device_time(Clock::time_point time) {
    return time.time_since_epoch();
}

}  // namespace

struct GigeServer::Impl {
    Impl(FrameSource& frames, const GigeServerOptions& settings);

    void run_control(const std::function<bool()>& stop);
    void answer(const UdpSocket& socket);
    void act_on(const GigeOutcome& outcome, const GigeStreamSettings& now);

    void run_streams();
    void stream(const GigeStreamSettings& settings);
    std::optional<ServedFrame> next_frame(const PixelFormat& format);
    void send(ServedFrame frame, const GigeStreamSettings& settings, nanoseconds stamp);
    bool wait_until(Clock::time_point due, std::uint64_t starts);

    FrameSource& source;
    GigeServerOptions options;
    std::uint32_t address;
    NetworkInterface interface;
    UdpSocket control;
    std::vector<UdpSocket> broadcasts;
    UdpSocket data;
    GvspSender sender;

    std::mutex mutex;  ///< of what follows
    GigeDevice device;
    std::condition_variable changed;
    bool stopping = false;
    std::exception_ptr failure;

    // Of the streaming thread.
    std::uint64_t offset = 0;       ///< added to numbers since the source began again
    std::uint64_t next_number = 0;  ///< after the last frame

    std::atomic<std::uint64_t> frames_sent{0};
    std::atomic<std::uint64_t> late_frames{0};
};

GigeServer::Impl::Impl(FrameSource& frames, const GigeServerOptions& settings)
    : source(frames),
      options(settings),
      address(address_of(options)),
      interface(own_interface(address)),
      control(control_socket(address)),
      data({address, 0}),
      sender(data, options.faults),
      device({.address = address,
              .netmask = interface.netmask,
              .mac = kLocalMac << 32U | address,
              .model = options.model,
              .version = options.version,
              .serial = options.serial.empty() ? ipv4_text(address) : options.serial,
              .can_resend = options.can_resend,
              .allow_other_destination = options.allow_other_destination},
             source.image()) {
    data.set_send_buffer(kSendBufferBytes);
    // Discovery comes as broadcasts. Without them the camera is still found by its address.
    for (const std::uint32_t to : {kLimitedBroadcast, address | ~interface.netmask}) try {
            broadcasts.emplace_back(UdpEndpoint{to, kGvcpPort}, true);
        } catch (const std::system_error&) {
        }
}

void GigeServer::Impl::run_control(const std::function<bool()>& stop) {
    std::vector<pollfd> sockets{{control.descriptor(), POLLIN, 0}};
    for (const UdpSocket& socket : broadcasts) sockets.push_back({socket.descriptor(), POLLIN, 0});
    while (!stop()) {
        static_cast<void>(poll(sockets.data(), sockets.size(), kPollMs));
        answer(control);
        for (const UdpSocket& socket : broadcasts) answer(socket);
        const std::scoped_lock lock(mutex);
        if (device.check_heartbeat(device_time(Clock::now()))) {
            sender.forget();
            changed.notify_all();
        }
        if (failure) std::rethrow_exception(failure);
    }
}

/// A loopback camera talks to loopback clients only: by another interface its frames would not
/// arrive, for clients with packet sockets listen on that interface.
void GigeServer::Impl::answer(const UdpSocket& socket) {
    while (const auto datagram = socket.receive()) {
        const bool broadcast = &socket != &control;
        if (broadcast && datagram->interface != interface.index) continue;
        if (is_loopback(address) != is_loopback(datagram->from.address)) continue;
        const auto command = decode_gvcp(datagram->bytes);
        if (!command) continue;
        if (broadcast && !std::holds_alternative<GvcpDiscovery>(command->body)) continue;
        std::unique_lock lock(mutex);
        const GigeOutcome outcome =
            device.execute(*command, datagram->from, device_time(Clock::now()));
        const GigeStreamSettings now = device.stream();
        if (!device.controller()) sender.forget();
        lock.unlock();
        changed.notify_all();
        act_on(outcome, now);
        if (!outcome.reply.empty()) control.send(datagram->from, outcome.reply);
    }
}

void GigeServer::Impl::act_on(const GigeOutcome& outcome, const GigeStreamSettings& now) {
    if (!now.destination.is_set()) return;
    data.set_do_not_fragment(now.do_not_fragment);
    if (outcome.resend) sender.resend(*outcome.resend, now.destination);
    if (outcome.fire_test_packet) data.send(now.destination, gvsp_test_packet(now.packet_bytes));
}

void GigeServer::Impl::run_streams() try {
    std::uint64_t begun = 0;
    for (std::unique_lock lock(mutex);;) {
        changed.wait(lock, [&] {
            return stopping || (device.stream().running && device.stream().starts != begun);
        });
        if (stopping) return;
        const GigeStreamSettings settings = device.stream();
        begun = settings.starts;
        lock.unlock();
        stream(settings);
        lock.lock();
        device.stream_ended(begun);
    }
} catch (...) {
    const std::scoped_lock lock(mutex);
    failure = std::current_exception();
}

void GigeServer::Impl::stream(const GigeStreamSettings& settings) {
    sender.forget();
    source.start(*settings.format);
    offset = next_number = 0;
    const nanoseconds period(static_cast<std::int64_t>(1e9 / settings.frames_hz));
    auto due = Clock::now();
    const nanoseconds begin = device_time(due);
    std::optional<std::uint64_t> first;
    const std::uint64_t end = settings.frames.value_or(UINT64_MAX);
    for (std::uint64_t sent = 0; sent < end; ++sent) {
        auto frame = next_frame(*settings.format);
        if (!frame || !wait_until(due, settings.starts)) return;
        const auto behind = Clock::now() - due;
        if (behind > period) ++late_frames;
        if (behind > kMaxPeriodsBehind * period) due += behind;
        due += period;
        const std::uint64_t number = number_with_gap(options.faults, frame->number);
        if (!first) first = number;
        if (sent < options.faults.begin_at) continue;
        if (options.faults.freeze_at && sent >= *options.faults.freeze_at) continue;
        // Unsigned: a damaged recording may have any ids.
        const auto since_begin = (number - *first) * static_cast<std::uint64_t>(period.count());
        const auto stamp = static_cast<std::uint64_t>(begin.count()) + since_begin;
        send(std::move(*frame), settings, nanoseconds(static_cast<std::int64_t>(stamp)));
    }
}

/// The next frame of the source; with `repeat`, numbers go on where it begins again.
std::optional<ServedFrame> GigeServer::Impl::next_frame(const PixelFormat& format) {
    auto frame = source.next();
    if (!frame && options.repeat && next_number > offset) {
        offset = next_number;
        source.start(format);
        frame = source.next();
    }
    if (!frame) return {};
    frame->number += offset;
    next_number = frame->number + 1;
    return frame;
}

void GigeServer::Impl::send(ServedFrame frame, const GigeStreamSettings& settings,
                            nanoseconds stamp) {
    const GvspFaults& faults = options.faults;
    const std::uint64_t number = number_with_gap(faults, frame.number);
    const std::uint64_t stamp_ns =
        frame.stamp_ns.value_or(static_cast<std::uint64_t>(stamp.count()));
    auto block = std::make_shared<NumberedBlock>();
    block->number = number;
    block->block = served_block(std::move(frame), source.image(), settings, stamp_ns);
    block->block.id = gvsp_block_id(number, faults.first_block);
    if (settings.destination.is_set() &&
        !sender.send(std::move(block), settings.destination,
                     {settings.packet_delay,
                      [&](Clock::time_point due) { return wait_until(due, settings.starts); }}))
        return;
    ++frames_sent;
}

/// False if the stream was stopped meanwhile.
bool GigeServer::Impl::wait_until(Clock::time_point due, std::uint64_t starts) {
    std::unique_lock lock(mutex);
    const auto is_over = [&] {
        const GigeStreamSettings now = device.stream();
        return stopping || !now.running || now.starts != starts;
    };
    return !changed.wait_until(lock, due, is_over);
}

GigeServer::GigeServer(FrameSource& source, const GigeServerOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}

GigeServer::~GigeServer() = default;

void GigeServer::run(const std::function<bool()>& stop) {
    impl_->stopping = false;
    std::jthread streams([this] { impl_->run_streams(); });
    const auto end = [this] {
        const std::scoped_lock lock(impl_->mutex);
        impl_->stopping = true;
        impl_->changed.notify_all();
    };
    try {
        impl_->run_control(stop);
    } catch (...) {
        end();
        throw;
    }
    end();
}

GigeServerCounts GigeServer::counts() const {
    const std::scoped_lock lock(impl_->mutex);
    return {.frames = impl_->frames_sent,
            .late_frames = impl_->late_frames,
            .packets = impl_->sender.packets_sent(),
            .packets_resent = impl_->sender.packets_resent(),
            .starts = impl_->device.stream().starts};
}

std::string GigeServer::client() const {
    const std::scoped_lock lock(impl_->mutex);
    const auto client = impl_->device.controller();
    return client ? fmt::format("{}:{}", ipv4_text(client->address), client->port) : "";
}

const std::string& GigeServer::xml() const {
    return impl_->device.xml();
}

}  // namespace stipple
