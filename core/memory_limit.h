#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>

#include "core/message.h"

namespace stipple {

/// While it lives, `max_memory` is so many bytes, whatever the machine has. Not for more than one
/// thread at a time.
class MemoryLimit {
  public:
    explicit MemoryLimit(std::uint64_t bytes);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;

  private:
    std::uint64_t before_;
};

/// Bytes of an input whose length does not bound its content: a camera, a growing file, a pipe.
inline constexpr std::uint64_t kEndlessInput = std::numeric_limits<std::uint64_t>::max();

/// Inputs of fewer bytes have limits of their own.
inline constexpr std::uint64_t kSmallInput = 1'000'000;

/// Bytes of a file, or of the files in a folder; kEndlessInput of what has no length.
[[nodiscard]] std::uint64_t input_bytes(const std::filesystem::path& file);

/// Bytes that may be taken at a time for an input of `input_bytes`: those of the living
/// MemoryLimit, else a quarter of `machine_memory`, of inputs below 1 MB no more than 256 MiB.
[[nodiscard]] std::uint64_t max_memory(std::uint64_t input_bytes = kEndlessInput);

/// Before memory is taken. \throws InputError at `where` if `bytes` for `what` are more than
/// `max_memory(input_bytes)`: it names both, and the option that allows it.
void check_memory(std::uint64_t bytes, const Message& where, std::string_view what,
                  std::uint64_t input_bytes = kEndlessInput);

/// Bytes of RAM, or of the lowest limit of the control groups that the process is in.
[[nodiscard]] std::uint64_t machine_memory(const std::filesystem::path& proc = "/proc/self",
                                           const std::filesystem::path& groups = "/sys/fs/cgroup");

/// Bytes of "512M", "2G", "1.5G": K, M, G and T are powers of 1024. Nothing for other texts, and
/// for less than 1 MiB.
[[nodiscard]] std::optional<std::uint64_t> parse_memory(std::string_view text);

}  // namespace stipple
