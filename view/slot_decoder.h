#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "decoder/decode_method.h"
#include "decoder/preview.h"
#include "session/decode_session.h"
#include "view/viewed_stream.h"

namespace stipple {

/// The pictures of a decoded stream, where they are looked at: one of a few slots at once (`live`,
/// then `fast`, of the slots around), and behind it the whole block of `decode`, whose pictures
/// have its bits. A thread for each level decodes what was asked for last, and drops what nobody
/// waits for. The better ones wait while a first picture is made, and until a slot has been looked
/// at for a moment.
class SlotDecoder {
  public:
    /// How good a picture is; each is better than those before.
    enum class Level { kNone, kLive, kFast, kBlock };

    /// `stream` must outlive this; `file` is its file. \throws InputError as DecodeSession.
    SlotDecoder(ViewedStream& stream, const std::filesystem::path& file, const DecodeSetup& setup,
                const CalibrationChoice& calibration);
    /// Of a running camera: without blocks, and with what the emulation leaves of the processor.
    explicit SlotDecoder(ViewedStream& stream);
    ~SlotDecoder();
    SlotDecoder(const SlotDecoder&) = delete;
    SlotDecoder& operator=(const SlotDecoder&) = delete;

    struct Picture {
        Level level = Level::kNone;
        std::shared_ptr<const std::vector<std::uint16_t>> codes =
            {};  ///< light_code, (plane, row, col)
    };
    /// Waits up to `wait` for a picture of `slot` that is better than `than`, or until `viewer`
    /// asks for another slot; nothing if none came. \throws InputError if the slot cannot be
    /// decoded.
    [[nodiscard]] std::optional<Picture> picture(const std::string& viewer, std::int64_t slot,
                                                 Level than, std::chrono::milliseconds wait);
    /// Ends decoding and waiting, now and later: pictures that are there are given.
    void end();
    /// What is there of a slot.
    [[nodiscard]] Picture known(std::int64_t slot) const;
    /// "live" (or "naive", PreviewDecoder), "fast", or the method of blocks.
    [[nodiscard]] std::string_view name_of(Level level) const;

  private:
    using Codes = std::shared_ptr<const std::vector<std::uint16_t>>;
    struct Wish {
        std::int64_t slot = 0;
        std::chrono::steady_clock::time_point asked;  ///< last
        std::chrono::steady_clock::time_point since;  ///< of this slot first
    };
    struct Task {
        std::int64_t slot = 0;
        Level level = Level::kNone;
    };

    /// Learns how far the stream has grown, and forgets the pictures that lacked what came.
    void look_for_more();
    [[nodiscard]] bool whole_block(std::int64_t slot) const;
    /// What decodes single slots by a level, for its thread.
    struct Decoding {
        std::shared_ptr<const StreamHeader> header;  ///< that decoder uses
        std::optional<PreviewDecoder> decoder;
    };
    /// The one for a header: a new one after each switch of the schedule.
    PreviewDecoder& decoder_of(Level level, const std::shared_ptr<const StreamHeader>& header);
    /// Decodes the tasks of a level.
    void run(Level level);
    void work(const Task& task);
    void decode_slot(const Task& task);
    void decode_block_of(std::int64_t slot);
    [[nodiscard]] bool on_camera() const { return !session_; }
    void start();
    [[nodiscard]] std::optional<Task> next_task(Level level);
    [[nodiscard]] bool first_wanted();
    [[nodiscard]] bool wanted(const Task& task) const;
    /// Waits while a first picture is made, unless the task is one. False if nobody waits for it.
    [[nodiscard]] bool goes_on(const Task& task);
    void store(std::int64_t slot, Level level, std::span<const float> light);
    [[nodiscard]] Picture best_of(std::int64_t slot) const;

    ViewedStream& stream_;
    DecodeMethod method_;
    DecodeOptions options_;
    std::array<Decoding, 2> decodings_;  ///< kLive, kFast
    std::atomic<DecodeMethod> live_method_;
    std::optional<DecodeSession> session_;  ///< of the blocks

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::string, Wish> wishes_;  ///< by viewer
    std::map<std::int64_t, std::array<Codes, 4>> pictures_;
    std::map<std::int64_t, std::string> failures_;
    std::size_t bytes_ = 0;  ///< of pictures_
    SlotExtent extent_;      ///< of the stream, when a viewer asked last
    std::atomic<bool> ended_ = false;
    std::array<std::thread, 3> threads_;  ///< last: start when all else is there
};

}  // namespace stipple
