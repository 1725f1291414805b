#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <semaphore>
#include <span>
#include <thread>
#include <vector>

#include "core/duration_histogram.h"
#include "core/message.h"
#include "decoder/preview.h"

namespace stipple {

struct LivePreviewOptions {
    std::function<void(const PreviewFrame&)> show;  ///< what it throws is a failure
    /// Told of a failure that is not that of the frame before.
    std::function<void(const Message&)> tell;
    std::function<bool()> keep_going;  ///< called while a frame is decoded; false cancels it
};

/// Figures of a preview.
struct PreviewCounts {
    int made = 0;
    int failed = 0;
    std::int64_t skipped_slots = 0;  ///< that no frame was decoded from
    std::int64_t last_slot = -1;     ///< that was shown
    DurationHistogram delays;        ///< from the light of the slot to its frame shown
};

/// Decoded preview of a live stream. A thread of idle priority decodes the newest slots, once eight
/// new ones have come; while it is busy, slots are skipped. The recorder never waits for it: the
/// slots are handed over without a lock, in memory that stays the recorder's, which keeps them from
/// one frame to the next. After a failure it goes on with the next frame. The options are called by
/// the thread.
class LivePreview {
  public:
    LivePreview(StreamHeader header, const PreviewOptions& decoding, LivePreviewOptions options);
    ~LivePreview();
    LivePreview(const LivePreview&) = delete;
    LivePreview& operator=(const LivePreview&) = delete;

    /// The packets of the next slot, whose light came at `arrival_ns` (CLOCK_MONOTONIC).
    void add(std::span<const SamplePacket> packets, std::int64_t arrival_ns);
    /// No more slots come. A frame that is being decoded is given up, but not the first one.
    /// `slow` is called if that takes longer than 2 s.
    void finish(const std::function<void()>& slow);

    /// Precondition: `finish` has returned.
    [[nodiscard]] PreviewCounts counts() const;
    [[nodiscard]] const PreviewDecoder& decoder() const { return decoder_; }

  private:
    void run();
    void show();
    void fail(const Message& failure);

    struct Slot {
        std::vector<SamplePacket> packets;
        std::size_t packet_count = 0;  ///< of packets that are in use
        std::int64_t arrival_ns = 0;
    };
    /// One that neither the newest slots nor those of the thread are in.
    Slot& free_slot();
    void hand_over();

    const StreamHeader header_;
    PreviewDecoder decoder_;
    const LivePreviewOptions options_;

    // Written by the recorder while `handed_over_` is false, read by the thread while it is true;
    // the slots of `window_` as well.
    std::vector<const Slot*> window_;  ///< that the thread decodes
    std::int64_t window_end_ = 0;      ///< slot after it; 0: there was none
    std::atomic<bool> handed_over_ = false;
    std::counting_semaphore<> wake_{0};

    std::binary_semaphore ended_{0};  ///< the thread

    // Of the recorder.
    std::vector<Slot> slots_;          ///< as many as the newest, those of the thread, and one
    std::vector<const Slot*> newest_;  ///< in their order
    std::int64_t next_slot_ = 0;
    std::int64_t skipped_ = 0;           ///< before window_
    std::vector<SamplePacket> packets_;  ///< of the thread: those of its window

    std::atomic<bool> give_up_ = false;
    std::atomic<int> made_ = 0;
    std::atomic<int> failed_ = 0;
    std::int64_t last_slot_ = -1;  ///< that was shown
    DurationHistogram delays_;
    Message failure_;     ///< the last one that was told
    std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace stipple
