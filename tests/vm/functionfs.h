#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace stipple {

/// A USB device in user space: the kernel's gadget framework with a function in FunctionFS, on the
/// controller of dummy_hcd, whose other end is a USB port of this machine. Its interfaces are those
/// of USB3 Vision: control (both ways) and stream (in).
class FunctionFs {
  public:
    /// Not plugged in yet. \throws std::system_error.
    explicit FunctionFs(const std::string& serial);

    void plug() const;
    void unplug() const;

    /// Waits for a request of the host; bytes read, or 0 if there is none (unplugged).
    [[nodiscard]] std::size_t read_request(std::span<std::uint8_t> buffer) const;
    void write_answer(std::span<const std::uint8_t> bytes) const;
    /// Whether the host took it; a signal to the thread ends the wait.
    [[nodiscard]] bool write_stream(std::span<const std::uint8_t> bytes) const;
    /// Waits until the host or the cable ends the connection.
    void wait_for_disconnection() const;

  private:
    std::filesystem::path gadget_;
    int control_ = -1;  ///< endpoint 0
    int answers_ = -1;
    int requests_ = -1;
    int stream_ = -1;
};

}  // namespace stipple
