#include "apps/output/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <new>
#include <string_view>
#include <utility>

#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kBarEvery{100};
constexpr std::chrono::seconds kLineEvery{5};
constexpr std::size_t kShortestBar = 8;
constexpr std::size_t kMaxBarCols = 24;

std::string bar(double part, std::size_t width) {
    const auto filled = static_cast<std::size_t>(part * static_cast<double>(width));
    return fmt::format("{:-<{}}", std::string(filled, '#'), width);
}

/// Characters that a line of the terminal takes without a break.
std::size_t terminal_columns() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 79;
    return size.ws_col - std::size_t{1};
}

}  // namespace

Progress::Progress(const RunOptions& run, std::string task, std::optional<std::int64_t> total,
                   std::string unit)
    : task_(std::move(task)),
      unit_(std::move(unit)),
      total_(total),
      terminal_(error_is_terminal()),
      start_(Clock::now()),
      work_(static_cast<double>(total.value_or(0))) {
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

void Progress::reach(double work, std::int64_t complete) {
    done_ = work;
    complete_ = complete;
    done_at_s_ = seconds();
}

void Progress::skip(double work) {
    work_ = work_ - work;
    ++complete_;
}

void Progress::note(std::string text) {
    const std::lock_guard lock(note_mutex_);
    note_ = std::move(text);
}

void Progress::show(const std::stop_token& stop) const {
    const std::chrono::milliseconds interval = terminal_ ? kBarEvery : kLineEvery;
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any stopped;
    const auto never = [] { return false; };
    while (stopped.wait_for(lock, stop, interval, never), !stop.stop_requested()) {
        try {
            terminal_ ? show_bar(line(terminal_columns())) : write_error_text(line(1000) + '\n');
        } catch (const std::bad_alloc&) {  // no memory: no line
        }
    }
}

std::string Progress::line(std::size_t columns) const {
    const std::int64_t complete = complete_;
    const std::optional<double> done = part();
    const std::string counter =
        done ? fmt::format("{:.0f} %, {}/{} {}s", std::floor(100 * *done), complete, *total_, unit_)
             : counted(complete, unit_);
    const std::string noted = counter + suffix();
    const std::string text = noted + pace();
    const std::size_t length = task_.size() + 1 + text.size();
    if (length > columns) return (noted.size() <= columns ? noted : counter).substr(0, columns);
    const std::size_t room = columns - length;
    if (!terminal_ || !done || room < kShortestBar + 3) return task_ + ' ' + text;
    return fmt::format("{} [{}] {}", task_, bar(*done, std::min(room - 3, kMaxBarCols)), text);
}

std::string Progress::suffix() const {
    const std::lock_guard lock(note_mutex_);
    return note_.empty() ? "" : ", " + note_;
}

std::optional<double> Progress::part() const {
    if (!total_ || *total_ < complete_) return {};
    return work_ > 0 ? std::clamp(done_ / work_, 0.0, 1.0) : 1.0;
}

std::string Progress::pace() const {
    const double done = done_;
    if (done <= 0) return {};
    const std::optional<double> done_part = part();
    const bool counts_units = done == static_cast<double>(complete_);
    std::string rate =
        counts_units ? fmt::format(", {} {}s/s", rounded(done / done_at_s_), unit_) : "";
    if (!done_part) return rate;
    const double now_s = seconds();
    const double rest = (1 - *done_part) / *done_part;
    double left_s = done_at_s_ * (1 + rest) - now_s;
    if (left_s < 0) left_s = now_s * rest;  // this step takes longer than those before it
    return rate + fmt::format(", {:%T} left", std::chrono::seconds(std::llround(left_s)));
}

}  // namespace stipple
