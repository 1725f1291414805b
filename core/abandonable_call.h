#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace stipple {

/// The result of `work`, which runs in a thread of its own; empty if `give_up` says so first. Then
/// the thread is left behind, and its result is dropped when it ends: for calls of libraries that
/// may wait for ever. `work` must own what it uses. \throws what `work` throws.
template <typename Work>
[[nodiscard]] std::optional<std::invoke_result_t<Work&>> call_unless(
    Work work, const std::function<bool()>& give_up) {
    constexpr std::chrono::milliseconds kAskEvery{20};
    std::packaged_task<std::invoke_result_t<Work&>()> task(std::move(work));
    auto result = task.get_future();
    std::thread(std::move(task)).detach();
    while (result.wait_for(kAskEvery) != std::future_status::ready)
        if (give_up()) return std::nullopt;
    return result.get();
}

}  // namespace stipple
