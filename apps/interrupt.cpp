#include "apps/interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>

#include "apps/standard_streams.h"
#include "io/pending_output.h"

namespace stipple {
namespace {

constexpr std::array kStopSignals{SIGINT, SIGTERM, SIGHUP};
/// `timeout` signals the program and then its group, a terminal that closes the same: signals that
/// come so soon after the first are the same wish.
constexpr std::int64_t kDebounceMs = 500;

std::atomic<int> received_signal{0};
/// When the first signal came; 0 before.
std::atomic<std::int64_t> received_ms{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);  // safe in a signal handler

std::int64_t now_ms() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
}

/// Ends the program as the signal does to programs that do not catch it.
void end_at_once(int signal) {
    if (!clear_bar()) write_error_text("\n");  // a terminal has shown ^C
    write_error_text("stipple: stopped at once\n");
    visit_partial_outputs([](const char* path) {
        write_error_text("stipple: what was written so far: ");
        write_error_text(path);
        write_error_text("\n");
    });
    struct sigaction normal {};
    normal.sa_handler = SIG_DFL;
    sigaction(signal, &normal, nullptr);
    raise(signal);  // delivered when the handler returns
}

void on_stop_signal(int signal) {
    const int interrupted_errno = errno;
    const std::int64_t now = now_ms();
    std::int64_t first = 0;
    if (received_ms.compare_exchange_strong(first, now)) {  // another thread may catch the next one
        received_signal = signal;
        if (!clear_bar() && signal == SIGINT) write_error_text("\n");
        write_error_text("stipple: stopping when this step is done; ");
        write_error_text(signal == SIGINT ? "a second Ctrl-C stops at once\n"
                                          : "a second signal stops at once\n");
    } else if (now - first > kDebounceMs) {
        end_at_once(signal);
    }
    errno = interrupted_errno;
}

}  // namespace

void catch_signals() {
    for (const int signal : kStopSignals) {
        struct sigaction before {};
        sigaction(signal, nullptr, &before);
        if (before.sa_handler == SIG_IGN) continue;  // as under nohup
        struct sigaction caught {};
        caught.sa_handler = on_stop_signal;
        for (const int other : kStopSignals) sigaddset(&caught.sa_mask, other);
        sigaction(signal, &caught, nullptr);  // no SA_RESTART: an open() that waits is to notice
    }
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

void reserve_standard_streams() {
    // Read-only, so that writing to a closed standard output still fails.
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor)
        if (fcntl(descriptor, F_GETFD) < 0)
            static_cast<void>(open("/dev/null", O_RDONLY));  // takes the lowest number that is free
}

int stop_signal() noexcept {
    return received_signal.load();
}

void throw_if_stopped(std::string_view left) {
    if (stop_signal() != 0) throw Interrupted{left};
}

SignalBlocker::SignalBlocker() {
    sigset_t stop;
    sigemptyset(&stop);
    for (const int signal : kStopSignals) sigaddset(&stop, signal);
    pthread_sigmask(SIG_BLOCK, &stop, &before_);
}

SignalBlocker::~SignalBlocker() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

}  // namespace stipple
