#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <semaphore>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/duration_histogram.h"
#include "decoder/preview.h"

namespace stipple {

/// Keeps a picture of what the decoder makes of a recording that is under way. A thread of idle
/// priority decodes the newest slots; while it is busy, slots pass it by. Whoever records never
/// waits for it: the slots are handed over without a lock, in memory that stays the recorder's.
/// What fails is said on standard error, and is tried again with the next picture.
class LivePreview {
  public:
    LivePreview(std::filesystem::path file, PreviewDecoder decoder);
    ~LivePreview();
    LivePreview(const LivePreview&) = delete;
    LivePreview& operator=(const LivePreview&) = delete;

    /// The packets of the next slot, whose light came at `arrival_ns` (CLOCK_MONOTONIC).
    void add(std::span<const SamplePacket> packets, std::int64_t arrival_ns);
    /// No more slots come. A picture that is being made is given up, but not the first one.
    void finish();

    /// After `finish`: the key `preview` of docs/cli.md, and the same for people.
    [[nodiscard]] nlohmann::ordered_json json() const;
    [[nodiscard]] std::string text() const;

  private:
    void run();
    void show();

    const std::filesystem::path file_;
    const PreviewDecoder decoder_;

    // Written by the recorder while `handed_over_` is false, read by the thread while it is true.
    std::vector<SamplePacket> packets_;
    std::size_t packet_count_ = 0;  ///< of packets_ that are in use
    std::int64_t first_slot_ = 0;
    std::int64_t shown_arrival_ns_ = 0;
    std::atomic<bool> handed_over_ = false;
    std::counting_semaphore<> wake_{0};

    std::binary_semaphore ended_{0};  ///< the thread

    std::int64_t next_slot_ = 0;  ///< of the recorder
    int gathered_ = 0;            ///< slots in packets_
    std::int64_t skipped_ = 0;

    std::atomic<bool> give_up_ = false;
    std::atomic<int> made_ = 0;
    std::atomic<int> failed_ = 0;
    std::int64_t last_slot_ = -1;  ///< that was shown
    DurationHistogram delays_;
    std::string failure_;  ///< the last one that was said
    std::thread thread_;   ///< last: starts when all else is there
};

}  // namespace stipple
