// Preloaded (LD_PRELOAD), this halts the first handler of SIGTERM for 0.2 s where it asks for the
// time. Meanwhile other threads handle the signals that follow.

#include <atomic>
#include <csignal>
#include <ctime>

#include "tests/apps/preloaded.h"

namespace {

void (*handler)(int) = nullptr;
thread_local bool is_handling = false;

void handle(int signal) {
    is_handling = true;
    handler(signal);
    is_handling = false;
}

}  // namespace

extern "C" int sigaction(int signal, const struct sigaction* wanted,
                         struct sigaction* before) noexcept {
    struct sigaction passed {};
    if (wanted != nullptr) passed = *wanted;
    if (signal == SIGTERM && passed.sa_handler != SIG_DFL && passed.sa_handler != SIG_IGN) {
        handler = passed.sa_handler;
        passed.sa_handler = handle;
    }
    return next<decltype(sigaction)>("sigaction")(signal, wanted == nullptr ? nullptr : &passed,
                                                  before);
}

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
    static std::atomic<bool> has_halted{false};
    const timespec halt{.tv_sec = 0, .tv_nsec = 200'000'000};
    if (is_handling && !has_halted.exchange(true)) nanosleep(&halt, nullptr);
    return next<decltype(clock_gettime)>("clock_gettime")(clock, time);
}
