#include "apps/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <string_view>
#include <utility>

#include "apps/standard_error.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kBarEvery{100};
constexpr std::chrono::seconds kLineEvery{5};

}  // namespace

Progress::Progress(const RunOptions& run, std::string task, std::optional<std::int64_t> total)
    : task_(std::move(task)),
      total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      start_(Clock::now()) {
    if (!run.quiet) display_ = std::jthread([this](const std::stop_token& stop) { show(stop); });
}

Progress::~Progress() {
    if (!display_.joinable()) return;
    display_.request_stop();
    display_.join();
    if (terminal_) show_bar("");
}

double Progress::seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

void Progress::reach(double frames) {
    done_ = frames;
    done_at_s_ = seconds();
}

void Progress::show(const std::stop_token& stop) const {
    const std::chrono::milliseconds interval = terminal_ ? kBarEvery : kLineEvery;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopped;
    const auto never = [] { return false; };
    while (stopped.wait_for(lock, stop, interval, never), !stop.stop_requested()) {
        terminal_ ? show_bar(line()) : write_error_text(line() + '\n');
    }
}

std::string Progress::line() const {
    const double exact = done_;
    const auto done = static_cast<std::int64_t>(exact);
    const double rate = exact > 0 ? exact / done_at_s_ : 0;
    const std::string rate_text = exact > 0 ? fmt::format(", {:.3g} frames/s", rate) : "";
    if (!total_ || *total_ < done) return fmt::format("{} {} frames{}", task_, done, rate_text);
    std::string text = task_ + ' ';
    if (terminal_) {
        constexpr std::int64_t kWidth = 24;
        const auto filled = static_cast<std::size_t>(kWidth * done / *total_);
        text += fmt::format("[{:-<{}}] ", std::string(filled, '#'), kWidth);
    }
    text += fmt::format("{}/{} frames{}", done, *total_, rate_text);
    if (rate == 0) return text;
    const double left_s = done_at_s_ + (static_cast<double>(*total_) - exact) / rate - seconds();
    if (left_s < 0) return text;  // this step takes longer than those before it
    const std::chrono::seconds left(static_cast<std::int64_t>(left_s));
    return text + fmt::format(", {:%T} left", left);
}

}  // namespace stipple
