#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "io/partial_output.h"

namespace stipple {

// What runs that were killed have left: partial outputs whose process is no longer there.

/// Says in a line on standard error that a run which was killed has left some of `output`, if so.
void say_leftover(const std::filesystem::path& output);

/// What the name of a file says beside its content: that a run is writing it, or was killed; empty
/// if it is no name of a partial output. Begins with "; ".
[[nodiscard]] std::string leftover_text(const std::filesystem::path& file);

/// What a partial output can become.
enum class Recoverable : std::uint8_t { kStream, kRecording, kNo };
[[nodiscard]] Recoverable recoverable(const std::filesystem::path& partial);

/// What became of a partial output.
struct Recovered {
    std::string text;             ///< how much of it was whole, for people
    std::uint64_t whole = 0;      ///< slots or frames
    std::uint64_t cut_bytes = 0;  ///< of a packet or frame that had begun
};

/// Cuts a stream or recording off behind its last whole packet or frame, and gives it the name
/// `output`. It has no end marker or record, by which readers know that it was cut off.
/// \throws InputError if nothing of it is whole or if `output` exists, DeviceError, Interrupted.
[[nodiscard]] Recovered recover(const std::filesystem::path& partial,
                                const std::filesystem::path& output);

}  // namespace stipple
