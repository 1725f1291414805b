#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "capture/capture_session.h"
#include "tests/capture/scripted_camera.h"

namespace stipple {

/// A bound that only a broken session reaches.
inline constexpr std::chrono::seconds kLong{10};

/// Opens one script after another; the last one for ever.
inline CaptureSession::Opener plays(std::vector<std::deque<ScriptedStep>> scripts,
                                    CameraDescription description = {}) {
    auto left = std::make_shared<std::vector<std::deque<ScriptedStep>>>(std::move(scripts));
    return [left, description] {
        auto camera = std::make_unique<ScriptedCamera>(left->front(), description);
        if (left->size() > 1) left->erase(left->begin());
        return camera;
    };
}

inline std::deque<ScriptedStep> frames(const std::vector<std::uint64_t>& wire_ids) {
    std::deque<ScriptedStep> steps;
    for (const std::uint64_t id : wire_ids)
        steps.push_back(arrives(scripted_frame(id, 5 * static_cast<std::int64_t>(id))));
    return steps;
}

/// Waits for the next event of that kind, past those where nothing happened.
template <typename Event>
Event wait_for(CaptureSession& session) {
    const auto end = std::chrono::steady_clock::now() + kLong;
    while (std::chrono::steady_clock::now() < end) {
        auto event = session.next(std::chrono::milliseconds(50));
        if (auto* wanted = std::get_if<Event>(&event)) return std::move(*wanted);
        if (!std::holds_alternative<NoFrame>(event)) {
            ADD_FAILURE() << "another event came first, of kind " << event.index();
            return {};
        }
    }
    ADD_FAILURE() << "nothing came";
    return {};
}

inline FrameRecord next_record(CaptureSession& session) {
    return wait_for<CapturedFrame>(session).record;
}

inline std::uint64_t lost(const CaptureSession& session, GapCause cause) {
    return session.totals().lost[static_cast<std::size_t>(cause)];
}

}  // namespace stipple
