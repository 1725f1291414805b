#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace stipple {

/// An output file. Each failure (such as a full disk) is a DeviceError that gives the name that the
/// user knows, but a pipe without a reader is a std::system_error.
class OutputFile {
  public:
    /// Creates `path`, or opens a pipe (is_pipe); messages name it `where`. \throws DeviceError.
    OutputFile(const std::filesystem::path& path, std::string where);

    void write(std::span<const std::byte> bytes);
    /// Continues at `offset` bytes from the start.
    void seek(long offset);
    /// Writes all data to the disk and closes the file.
    void close();

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    [[noreturn]] void fail() const;

    std::string where_;
    std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace stipple
