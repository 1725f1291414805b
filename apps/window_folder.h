#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "apps/shared_folder.h"
#include "core/geometry.h"

namespace stipple {

/// All that determines the frames of a decoded stream.
struct WindowIdentity {
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

/// A folder with a decoded stream in windows, each a complete file `window_000000.npy` or absent.
/// The windows are the blocks that the decoder decodes independently. `decoding.json` holds the
/// identity. Each window names its number and the CRC of the identity, so that none of another
/// decoding is taken for one of this.
class WindowFolder {
  public:
    /// Of a decoding that begins or goes on. \throws InputError if the folder holds the windows of
    /// another decoding, or anything else.
    WindowFolder(std::filesystem::path folder, const WindowIdentity& identity);
    /// Opens the folder of a decoding. \throws InputError if it is none, or of another version.
    explicit WindowFolder(std::filesystem::path folder);

    /// Makes the folder and decoding.json, unless they are there. Several processes may do so at
    /// the same time. \throws as claim_folder.
    void claim();
    [[nodiscard]] const WindowIdentity& identity() const { return identity_; }
    /// Number of windows.
    [[nodiscard]] std::int64_t count() const;
    /// The file of a window, 0..count() - 1.
    [[nodiscard]] std::filesystem::path window(std::int64_t number) const;
    /// The comment in the header of a window. Precondition: the folder has its decoding.json.
    [[nodiscard]] std::string mark(std::int64_t number) const;
    /// The slots of a window: [begin_slot, end_slot).
    [[nodiscard]] std::int64_t begin_slot(std::int64_t number) const;
    [[nodiscard]] std::int64_t end_slot(std::int64_t number) const;
    /// All of them, while this object lives. To ask for one of another decoding \throws InputError.
    [[nodiscard]] NumberedParts windows() const;

  private:
    /// Whether the window is there, with all of its frames.
    [[nodiscard]] bool holds(std::int64_t number) const;

    std::filesystem::path folder_;
    WindowIdentity identity_;
    std::optional<std::string> decoding_;  ///< the text of decoding.json, once that is there
};

}  // namespace stipple
