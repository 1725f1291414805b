#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <utility>
#include <variant>

#include "capture/camera.h"

namespace stipple {

/// The camera takes the payloads of its frames from its pool: with memory for the frame that it
/// delivers and for one that it has read ahead, none is allocated later.
inline void expect_frames_from_pool(Camera& camera, int frames) {
    FramePool pool;
    pool.reserve(2, camera.layout().payload_bytes());
    camera.use(pool);
    camera.start();
    for (int taken = 0; taken < frames;) {
        Arrival arrival = camera.wait(std::chrono::seconds(5));
        ASSERT_FALSE(std::holds_alternative<DeviceLost>(arrival));
        auto* const frame = std::get_if<CapturedFrame>(&arrival);
        if (frame == nullptr) continue;
        EXPECT_EQ(frame->payload.size(), camera.layout().payload_bytes());
        pool.give_back(std::move(frame->payload));
        ++taken;
    }
    camera.stop();
    EXPECT_EQ(pool.misses(), 0U);
}

}  // namespace stipple
