#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace stipple {

/// A file being written, where each failure (a full disk, say) is a DeviceError that names the
/// output under the name its user knows.
class OutputFile {
  public:
    /// Creates `path`. Messages say `place`. \throws DeviceError.
    OutputFile(const std::filesystem::path& path, std::string place);

    void write(std::span<const std::byte> bytes);
    /// Continues at `offset` bytes from the start.
    void seek(long offset);
    /// Hands everything to the disk and closes the file.
    void close();

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    [[noreturn]] void fail() const;

    std::string place_;
    std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace stipple
