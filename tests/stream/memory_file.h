#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <span>
#include <string>

namespace stipple {

/// A file in memory that is read through a path: thousands of them cost no disk.
class MemoryFile {
  public:
    explicit MemoryFile(std::span<const char> bytes) : descriptor_(memfd_create("stream", 0)) {
        good_ = write(descriptor_, bytes.data(), bytes.size()) == std::ssize(bytes);
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] bool good() const { return good_; }
    [[nodiscard]] std::filesystem::path path() const {
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

  private:
    int descriptor_;
    bool good_;
};

}  // namespace stipple
