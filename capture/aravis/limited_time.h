#pragma once

#include <chrono>
#include <string>
#include <type_traits>
#include <utility>

#include "core/abandonable_call.h"
#include "core/error.h"

namespace stipple {

/// The result of `work` with the camera at `address`, for which Aravis waits as long as the camera
/// asks it to (PENDING_ACK). `work` must own what it uses. \throws DeviceError after two minutes,
/// and what `work` throws.
template <typename Work>
[[nodiscard]] std::invoke_result_t<Work&> within_limited_time(const std::string& address,
                                                              Work work) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    auto result =
        call_unless(std::move(work), [end] { return std::chrono::steady_clock::now() > end; });
    if (!result) throw DeviceError(address, "camera lost: it did not answer in two minutes");
    return std::move(*result);
}

}  // namespace stipple
