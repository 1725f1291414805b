#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace stipple {

/// Waits for a stream that another program is writing: `more` is a WaitForMore. It gives up when
/// the file has not grown for `timeout_s` seconds, or when a signal asks to stop.
class StreamFollower {
  public:
    StreamFollower(std::string stream, double timeout_s)
        : stream_(std::move(stream)), timeout_(timeout_s) {}

    /// Until there is a file of that name, or one that a run is going to give that name when it is
    /// complete. Returns the one to read. \throws InputError if none appears, Interrupted.
    [[nodiscard]] std::filesystem::path wait_for_file();
    [[nodiscard]] bool more(std::uint64_t bytes);

    /// True if the file has ceased to grow without an end marker.
    [[nodiscard]] bool timed_out() const { return timed_out_; }
    [[nodiscard]] double timeout_s() const { return timeout_.count(); }

  private:
    using Clock = std::chrono::steady_clock;

    std::string stream_;
    std::chrono::duration<double> timeout_;
    std::uint64_t bytes_ = 0;
    Clock::time_point grown_at_ = Clock::now();
    bool timed_out_ = false;
};

}  // namespace stipple
