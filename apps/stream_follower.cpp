#include "apps/stream_follower.h"

#include <fmt/format.h>

#include <filesystem>
#include <thread>

#include "apps/interrupt.h"
#include "core/error.h"
#include "io/partial_output.h"

namespace stipple {
namespace {

/// Short against the slots that a block waits for, long against a look at the file.
constexpr std::chrono::milliseconds kLookEvery{20};

}  // namespace

std::filesystem::path StreamFollower::wait_for_file() {
    for (;;) {
        if (std::filesystem::exists(stream_)) return stream_;
        if (const auto partial = partial_of(stream_)) return *partial;
        const bool goes_on = more(0);
        throw_if_stopped();
        if (!goes_on)
            throw InputError(stream_, fmt::format("has not appeared within {:g} s; start its "
                                                  "writer first, or raise --timeout",
                                                  timeout_s()));
    }
}

bool StreamFollower::more(std::uint64_t bytes) {
    if (stop_signal() != 0) return false;
    const auto now = Clock::now();
    if (bytes > bytes_) {
        bytes_ = bytes;
        grown_at_ = now;
    }
    timed_out_ = now - grown_at_ > timeout_;
    if (!timed_out_) std::this_thread::sleep_for(kLookEvery);
    return !timed_out_;
}

}  // namespace stipple
