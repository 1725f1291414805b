#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// A USB3 Vision camera without its USB: control requests to answers, frames to transfers. Its
/// frames are those of tests/capture/fake_frame.h. Layouts and registers as in USB3 Vision 1.0.1
/// and GenCP 1.1, little-endian.
class Usb3VisionDevice {
  public:
    explicit Usb3VisionDevice(const std::string& serial);

    /// The transfers of a frame.
    struct Block {
        std::vector<std::uint8_t> leader;
        std::vector<std::uint8_t> payload;
        std::vector<std::uint8_t> trailer;
    };

    /// The answer to a request; empty if it is none.
    [[nodiscard]] std::vector<std::uint8_t> answer(std::span<const std::uint8_t> request);
    [[nodiscard]] bool is_streaming() const;
    [[nodiscard]] double frame_rate_hz() const;
    [[nodiscard]] Block next_block();
    void stop_streaming();

    /// Leaves out as many ids before the next frame.
    void skip(std::uint64_t frames);
    /// Sends no more than `bytes` of the next frame.
    void cut(std::size_t bytes);
    void lose_trailer();                  ///< of the next frame
    void set_width(std::uint32_t width);  ///< also while it streams, as only odd cameras do

  private:
    void place(std::uint64_t address, std::uint64_t value, int bytes);
    void place(std::uint64_t address, const std::string& text);
    void place(std::uint64_t address, double value);
    [[nodiscard]] std::uint64_t value_at(std::uint64_t address, int bytes) const;
    [[nodiscard]] std::size_t frame_bytes() const;
    [[nodiscard]] std::size_t transfer_bytes() const;
    [[nodiscard]] bool has(std::uint64_t address, std::size_t bytes) const;
    void written(std::uint64_t address);

    mutable std::mutex mutex_;  ///< of what follows
    std::vector<std::uint8_t> memory_;
    bool acquiring_ = false;
    std::uint64_t next_id_ = 0;
    std::uint64_t skipped_ = 0;
    std::size_t max_bytes_ = ~std::size_t{0};
    bool loses_trailer_ = false;
};

}  // namespace stipple
