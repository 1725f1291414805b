#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace stipple {

/// A file that another program is writing. A reader waits for more bytes with `more`, until the
/// file has not grown for `timeout_s` seconds or `is_stopped` returns true. Of a StreamReader it is
/// the WaitForMore.
class GrowingFile {
  public:
    GrowingFile(std::filesystem::path name, double timeout_s, std::function<bool()> is_stopped);

    /// Waits until there is a file of that name, or a partial output that will get the name when it
    /// is complete. Returns the path to read; nothing if it was stopped. \throws InputError after
    /// the timeout.
    [[nodiscard]] std::optional<std::filesystem::path> wait_for_file();
    /// Called when `bytes` bytes have been read and no more are there. Pauses and returns true to
    /// read again; false if nothing more is to be expected.
    [[nodiscard]] bool more(std::uint64_t bytes);

    /// True if the last call of `more` gave up after the timeout.
    [[nodiscard]] bool timed_out() const { return timed_out_; }
    [[nodiscard]] double timeout_s() const { return timeout_.count(); }

  private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path name_;
    std::chrono::duration<double> timeout_;
    std::function<bool()> is_stopped_;
    std::uint64_t bytes_ = 0;
    Clock::time_point grown_at_ = Clock::now();
    bool timed_out_ = false;
};

}  // namespace stipple
