#include "io/growing_file.h"

#include <fmt/format.h>

#include <thread>
#include <utility>

#include "core/error.h"
#include "io/partial_output.h"

namespace stipple {
namespace {

/// Short compared with the slots that a block waits for, long compared with a look at the file.
constexpr std::chrono::milliseconds kLookEvery{20};

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path name, double timeout_s,
                         std::function<bool()> is_stopped)
    : name_(std::move(name)), timeout_(timeout_s), is_stopped_(std::move(is_stopped)) {}

std::optional<std::filesystem::path> GrowingFile::wait_for_file() {
    for (;;) {
        if (std::filesystem::exists(name_)) return name_;
        if (auto partial = partial_of(name_)) return partial;
        if (more(0)) continue;
        if (!timed_out_) return std::nullopt;
        throw InputError(
            name_.string(),
            fmt::format("has not appeared within {:g} s; start its writer first, or raise ",
                        timeout_s()) +
                Parameter{"timeout"});
    }
}

bool GrowingFile::more(std::uint64_t bytes) {
    timed_out_ = false;
    if (is_stopped_()) return false;
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
