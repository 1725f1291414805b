#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace stipple {

/// A new file that grows at its end; each block of bytes is visible to readers at once.
class AppendFile {
  public:
    /// Creates or truncates `file`. Messages call it `where`.
    /// All members \throws DeviceError naming `where` (a full disk, say).
    AppendFile(const std::filesystem::path& file, std::string where);
    ~AppendFile();
    AppendFile(const AppendFile&) = delete;
    AppendFile& operator=(const AppendFile&) = delete;

    void append(std::span<const std::uint8_t> bytes);
    void close();
    /// After a failure: truncates the file to `bytes` bytes if the system allows it.
    void cut(std::uint64_t bytes) noexcept;

    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  private:
    [[noreturn]] void fail() const;

    std::string where_;
    int descriptor_;
    std::uint64_t bytes_ = 0;
};

}  // namespace stipple
