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
    void advance() { reach(static_cast<double>(done_) + 1); }
    /// So many frames are done, the last one perhaps in part.
    void reach(double frames);

    [[nodiscard]] std::int64_t done() const { return static_cast<std::int64_t>(done_); }
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
    std::atomic<double> done_ = 0;
    std::atomic<double> done_at_s_ = 0;  ///< when `done_` was last set
    std::jthread display_;               ///< last: it reads the others
};

}  // namespace stipple
