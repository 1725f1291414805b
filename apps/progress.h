#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "apps/run_options.h"

namespace stipple {

/// Shows on standard error how far a run has come: on a terminal a bar with rate and time left,
/// else a line every few seconds, when quiet nothing. It shows it by itself: frames may come in
/// bursts, with long work between them.
class Progress {
  public:
    /// `task` as in "emulating". `total` frames, if known.
    Progress(const RunOptions& run, std::string task, std::optional<std::int64_t> total);
    /// Takes the bar away.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more frame is done.
    void advance();

    [[nodiscard]] std::int64_t done() const { return done_; }
    /// Since the construction.
    [[nodiscard]] double seconds() const;

  private:
    using Clock = std::chrono::steady_clock;
    void show(const std::stop_token& stop) const;
    [[nodiscard]] std::string line() const;

    std::string task_;
    std::optional<std::int64_t> total_;
    bool terminal_;
    Clock::time_point start_;
    std::atomic<std::int64_t> done_ = 0;
    std::atomic<double> done_at_s_ = 0;  ///< when the last frame was done
    std::jthread display_;               ///< last: it reads the others
};

}  // namespace stipple
