#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "decoder/reconstruct.h"
#include "readout/rig.h"
#include "stream/stream_reader.h"

namespace stipple {

/// The folder of a rig: rig.toml and a stream for each sensor (docs/rig.md).
struct RigFolder {
    Rig rig;
    std::deque<StreamReader> readers;  ///< in the order of the sensors

    /// For `decode_rig`; valid while this lives.
    [[nodiscard]] std::vector<RigStream> streams();
};

/// True if `path` is a folder with a rig.toml.
[[nodiscard]] bool is_rig_folder(const std::filesystem::path& path);

/// \throws InputError as read_rig and StreamReader; if a stream is missing; and if one is not that
/// of the rig: of other footage than the first, or with other bytes than rig.toml tells.
/// `check` is called before each MiB of a stream whose bytes are compared, and may throw to give
/// up.
[[nodiscard]] RigFolder open_rig_folder(
    const std::filesystem::path& folder, ReadPolicy policy,
    const std::function<void()>& check = [] {});

}  // namespace stipple
