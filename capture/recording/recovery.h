#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace stipple {

/// What a partial output can become.
enum class Recoverable : std::uint8_t { kStream, kRecording, kNo };
[[nodiscard]] Recoverable recoverable(const std::filesystem::path& partial);

/// What became of a partial output.
struct Recovered {
    Recoverable kind = Recoverable::kNo;
    std::uint64_t whole = 0;      ///< slots or frames
    std::uint64_t cut_bytes = 0;  ///< of a packet or frame that had begun
    bool complete = false;        ///< it has its end marker or record
};

/// Cuts a stream or recording off behind its last whole packet or frame, and gives it the name
/// `output`. It has no end marker or record, by which readers know that it was cut off. `check` is
/// called after each packet or frame that is read, and may throw to give up.
/// \throws InputError if nothing of it is whole or if `output` exists, DeviceError.
[[nodiscard]] Recovered recover(const std::filesystem::path& partial,
                                const std::filesystem::path& output,
                                const std::function<void()>& check);

}  // namespace stipple
