#include "apps/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

namespace stipple {
namespace {

std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);  // safe in a signal handler

void remember(int signal) {
    constexpr std::string_view kText =
        "\nstipple: stopping when this step is done; a second Ctrl-C stops at once\n";
    const int interrupted_errno = errno;
    received_signal.store(signal);
    // Whether or not somebody can read it.
    static_cast<void>(!write(STDERR_FILENO, kText.data(), kText.size()));
    errno = interrupted_errno;
}

}  // namespace

void catch_signals() {
    struct sigaction once {};
    once.sa_handler = remember;
    once.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
    sigaction(SIGINT, &once, nullptr);
    sigaction(SIGTERM, &once, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
}

int stop_signal() noexcept {
    return received_signal.load();
}

void throw_if_stopped() {
    if (stop_signal() != 0) throw Interrupted();
}

}  // namespace stipple
