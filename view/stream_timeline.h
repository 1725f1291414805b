#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <vector>

#include "stream/stream_reader.h"

namespace stipple {

/// What happens in a stream from its first slot to its last one, in at most 1024 bins of equally
/// many slots. A thread of its own reads the stream once, and goes on while it grows.
class StreamTimeline {
  public:
    /// \throws InputError as StreamReader.
    explicit StreamTimeline(const std::filesystem::path& file);
    ~StreamTimeline();
    StreamTimeline(const StreamTimeline&) = delete;
    StreamTimeline& operator=(const StreamTimeline&) = delete;

    /// What has been read so far: `slots_per_bin`; by bin `samples`, `saturated`, `missing` slots
    /// and `dropped`, slots whose last rows did not fit; `slots` and `complete`; `damage`, the
    /// places where the stream is damaged, each with its `byte` and `cause`.
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    struct Bin {
        std::uint64_t samples = 0;
        std::uint64_t saturated = 0;
        std::int64_t whole_slots = 0;
        std::int64_t dropped = 0;
    };
    void run();
    /// At the present end of the file. False if no more comes.
    bool wait_for_more();
    void add(const SamplePacket& packet, std::uint64_t saturated);

    StreamReader reader_;
    mutable std::mutex mutex_;
    std::vector<Bin> bins_;
    std::int64_t slots_per_bin_ = 1;
    StreamReport report_;  ///< of the reader, a moment ago
    std::string failure_;
    std::atomic<bool> ended_ = false;
    std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace stipple
