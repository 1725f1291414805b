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

/// Shows on standard error how far a run has come: on a terminal a bar with rate and time left,
/// else a line every few seconds, when quiet nothing. It shows it by itself: frames may come in
/// bursts, with long work between them.
class Progress {
  public:
    /// `task` as in "emulating". `total` frames or what else `unit` names, if known.
    Progress(const RunOptions& run, std::string task, std::optional<std::int64_t> total,
             std::string unit = "frame");
    /// Takes the bar away.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// One more frame is done.
    void advance() { reach(static_cast<double>(done_) + 1); }
    /// One more frame is there without work: it tells nothing of the time that others take.
    void skip();
    /// So much work is done, in frames; `complete` of them are, and would be kept if it ended now.
    void reach(double frames, std::int64_t complete);
    void reach(double frames) { reach(frames, static_cast<std::int64_t>(frames)); }

    /// The remark behind the counter from now on, as "3 lost"; empty: none.
    void note(std::string text);

    [[nodiscard]] std::int64_t done() const { return complete_; }
    /// Since the construction.
    [[nodiscard]] double seconds() const;

  private:
    using Clock = std::chrono::steady_clock;
    void show(const std::stop_token& stop) const;
    /// Fits into `columns`.
    [[nodiscard]] std::string line(std::size_t columns) const;
    /// The note with a comma before it.
    [[nodiscard]] std::string note_behind() const;
    [[nodiscard]] std::string bar(std::size_t width) const;
    /// Rate and time left, as far as they are known.
    [[nodiscard]] std::string pace() const;

    std::string task_;
    std::string unit_;  ///< one of them
    std::optional<std::int64_t> total_;
    bool terminal_;
    Clock::time_point start_;
    std::atomic<double> done_ = 0;
    std::atomic<std::int64_t> complete_ = 0;
    std::atomic<std::int64_t> skipped_ = 0;
    std::atomic<double> done_at_s_ = 0;  ///< when `done_` was last set
    mutable std::mutex note_mutex_;
    std::string note_;
    std::jthread display_;  ///< last: it reads the others
};

}  // namespace stipple
