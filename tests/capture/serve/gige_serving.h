#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "capture/network.h"
#include "capture/serve/gige_server.h"
#include "capture/serve/udp_socket.h"
#include "core/error.h"
#include "core/philox.h"

namespace stipple {

/// Frames of random bytes, the same for the same number and format.
class NoiseFrames final : public FrameSource {
  public:
    NoiseFrames(int width, int height, std::vector<std::string> formats, std::uint64_t frames) {
        image_.width = width;
        image_.height = height;
        for (const auto& name : formats)
            if (const PixelFormat* format = pixel_format_named(name))
                image_.formats.push_back(format);
        image_.frames_hz = 200;
        image_.frames = frames;
    }

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override {
        format_ = &format;
        number_ = 0;
    }
    [[nodiscard]] std::optional<ServedFrame> next() override {
        if (number_ >= *image_.frames) return {};
        ServedFrame frame{bytes(number_, *format_), number_};
        ++number_;
        return frame;
    }

    /// Frame `number` in a format.
    [[nodiscard]] std::vector<std::uint8_t> bytes(std::uint64_t number,
                                                  const PixelFormat& format) const {
        std::vector<std::uint8_t> bytes(format.row_bytes(image_.width) *
                                        static_cast<std::size_t>(image_.height));
        for (std::size_t i = 0; i < bytes.size(); i += 4) {
            const auto word = philox4x32(
                {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(number), 0, 0}, 7)[0];
            for (std::size_t k = 0; k < 4 && i + k < bytes.size(); ++k)
                bytes[i + k] = static_cast<std::uint8_t>(word >> (8 * k));
        }
        return bytes;
    }

  private:
    ServedImage image_;
    const PixelFormat* format_ = nullptr;
    std::uint64_t number_ = 0;
};

/// A server on a loopback address of its own, running.
class GigeServing {
  public:
    explicit GigeServing(FrameSource& source, GigeServerOptions options = {}) {
        // Each process starts elsewhere in 127/8; if somebody is there already, try on.
        const auto start = static_cast<std::uint32_t>(getpid()) * 251U;
        for (std::uint32_t i = 0; i < 1000 && !server_; ++i) {
            address_ = 0x7F000000U | ((start + i) % 0xFFFFFCU + 2);
            options.address = ipv4_text(address_);
            try {
                server_ = std::make_unique<GigeServer>(source, options);
            } catch (const DeviceError& e) {
                failure_ = e.what();
            }
        }
        if (server_)
            thread_ = std::jthread([this] { server_->run([this] { return stop_.load(); }); });
    }
    ~GigeServing() { stop(); }
    GigeServing(const GigeServing&) = delete;
    GigeServing& operator=(const GigeServing&) = delete;

    void stop() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }

    [[nodiscard]] std::uint32_t address() const { return address_; }
    [[nodiscard]] const GigeServer& server() const { return *server_; }
    /// Why there is none, or empty.
    [[nodiscard]] std::string failure() const { return server_ ? "" : failure_; }

  private:
    std::uint32_t address_ = 0;
    std::unique_ptr<GigeServer> server_;
    std::string failure_;
    std::atomic<bool> stop_{false};
    std::jthread thread_;
};

}  // namespace stipple
