#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/geometry.h"
#include "session/decode_setup.h"
#include "session/shard.h"
#include "session/stream_calibration.h"
#include "stream/stream_reader.h"

namespace stipple {

/// A decoding of a stream that lies in a file, whose windows several processes share.
struct ShardedDecoding {
    std::filesystem::path stream;
    DecodeSetup setup;
    CalibrationChoice calibration = {};
    ReadPolicy policy = ReadPolicy::kTolerant;
    std::function<void(const Message&)> warn = [](const Message&) {};
};

/// All that determines the frames of a decoded stream: the keys of docs/scaling.md.
struct DecodingIdentity {
    std::uint64_t stream_bytes = 0;
    std::string stream;  ///< as stream_identity, or else its hash
    std::string method;
    std::string options;             ///< lines of TOML; empty: the defaults
    std::string calibration_sha256;  ///< empty: without
    bool fill_gaps = false;
    std::int64_t slots = 0;
    FrameShape shape = {};  ///< of the decoded frames
    double slot_us = 0;
};

/// Reads the files whole; `check` is called before each MiB and packet, and may throw to give up.
/// \throws InputError if one cannot be read, or the stream holds no slot.
[[nodiscard]] DecodingIdentity identity_of(const ShardedDecoding& decoding,
                                           const std::function<void()>& check);

/// As JSON, and back. \throws InputError naming `where` if it is not that of a decoding, or of
/// another version.
[[nodiscard]] std::string identity_text(const DecodingIdentity& identity);
[[nodiscard]] DecodingIdentity parse_identity(const std::string& text,
                                              const std::filesystem::path& where);

/// The comment in the header of window `number` of a decoding: it has the CRC-32C of `decoding`,
/// the text of its decoding.json, so that no window of another decoding is taken for it.
[[nodiscard]] std::string window_mark(std::int64_t number, std::string_view decoding);

/// A folder with a decoded stream in windows, each a complete file `window_000000.npy` or absent.
/// The windows are the blocks that the decoder decodes independently. `decoding.json` holds the
/// identity. Each window names its number and the CRC of the identity, so that none of another
/// decoding is taken for one of this.
class VideoShards {
  public:
    /// Of a decoding that begins or goes on. \throws InputError if the folder holds the windows of
    /// another decoding, or anything else.
    VideoShards(std::filesystem::path folder, const DecodingIdentity& identity);
    /// Opens the folder of a decoding. \throws InputError if it is none, or of another version.
    explicit VideoShards(std::filesystem::path folder);

    /// Whether the folder has its decoding.json.
    [[nodiscard]] bool claimed() const { return decoding_.has_value(); }
    /// Makes the folder and decoding.json, unless they are there. Several processes may do so at
    /// the same time. \throws InputError as the constructor; DeviceError if it cannot be written.
    void claim();
    [[nodiscard]] const DecodingIdentity& identity() const { return identity_; }
    /// Number of windows.
    [[nodiscard]] std::int64_t count() const;
    /// The file of a window, 0..count() - 1.
    [[nodiscard]] std::filesystem::path window(std::int64_t number) const;
    /// The slots of a window: [begin_slot, end_slot).
    [[nodiscard]] std::int64_t begin_slot(std::int64_t number) const;
    [[nodiscard]] std::int64_t end_slot(std::int64_t number) const;
    /// All of them, while this object lives. To ask for one of another decoding \throws InputError.
    [[nodiscard]] NumberedFiles windows() const;
    /// \throws InputError naming those that are missing.
    void require_all() const;

    /// Stores the frames of a window one after the other; it appears when the last one is written.
    /// Precondition: claimed().
    class Writer {
      public:
        Writer(const VideoShards& folder, std::int64_t number);
        ~Writer();
        Writer(Writer&&) noexcept;
        Writer& operator=(Writer&&) noexcept;
        /// Returns true after the last frame. \throws DeviceError.
        bool write(std::span<const float> frame);

      private:
        struct Impl;
        std::unique_ptr<Impl> impl_;
    };

  private:
    /// Whether the window is there, with all of its frames.
    [[nodiscard]] bool holds(std::int64_t number) const;
    [[nodiscard]] std::string mark(std::int64_t number) const;

    std::filesystem::path folder_;
    DecodingIdentity identity_;
    std::optional<std::string> decoding_;  ///< the text of decoding.json, once that is there
};

/// Decodes the windows of a range; each is stored when it is complete. `progress` receives slots of
/// the range, and how many of them are stored or being stored. Returns the report of the stream, or
/// nothing if `progress` has stopped it. \throws as `decode`; InputError if the stream has changed.
[[nodiscard]] std::optional<StreamReport> decode_windows(
    VideoShards& folder, const ShardedDecoding& decoding, const NumberRange& windows,
    const std::function<bool(double slots, std::int64_t frames)>& progress);

}  // namespace stipple
