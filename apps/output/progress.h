#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/arguments/run_options.h"

namespace stipple {

/// Shows on standard error how far a run has come: on a terminal a bar with percentage and time
/// left, else a line every few seconds, when quiet nothing. It shows it by itself: frames may come
/// in bursts, with long work between them.
class Progress {
  public:
    /// `task` as in "emulating". `total` frames or what else `unit` names, if known.
    Progress(const RunOptions& run, std::string task, std::optional<std::int64_t> total,
             std::string unit = "frame");
    /// Takes the bar away.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// All work, in the unit of `reach`, if it is not the number of frames.
    void set_work(double work) { work_ = work; }
    /// One more frame is done.
    void advance() { reach(static_cast<double>(done_) + 1); }
    /// One more frame is there, and its work need not be done.
    void skip(double work = 1);
    /// So much work is done; `complete` frames are, and would be kept if it ended now.
    void reach(double work, std::int64_t complete);
    void reach(double frames) { reach(frames, static_cast<std::int64_t>(frames)); }

    /// The remark behind the counter from now on, as "3 lost"; empty: none.
    void note(std::string text);

    [[nodiscard]] std::int64_t done() const { return complete_; }
    [[nodiscard]] double work_done() const { return done_; }
    /// Since the construction.
    [[nodiscard]] double seconds() const;

  private:
    using Clock = std::chrono::steady_clock;
    void show(const std::stop_token& stop) const;
    /// Fits into `columns`.
    [[nodiscard]] std::string line(std::size_t columns) const;
    /// The note with a comma before it.
    [[nodiscard]] std::string suffix() const;
    /// The part of the work that is done, 0..1; none: all work is unknown.
    [[nodiscard]] std::optional<double> part() const;
    /// The rate, if work is counted in frames, and the time left, if all work is known.
    [[nodiscard]] std::string pace() const;

    std::string task_;
    std::string unit_;  ///< one of them
    std::optional<std::int64_t> total_;
    bool terminal_;
    Clock::time_point start_;
    std::atomic<double> work_;  ///< all of it, if `total_` is known
    std::atomic<double> done_ = 0;
    std::atomic<std::int64_t> complete_ = 0;
    std::atomic<double> done_at_s_ = 0;  ///< when `done_` was last set
    mutable std::mutex note_mutex_;
    std::string note_;
    std::jthread display_;  ///< last: it reads the others
};

}  // namespace stipple
