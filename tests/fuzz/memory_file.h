#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

namespace stipple {

/// A file in memory that is read through a path.
class MemoryFile {
  public:
    explicit MemoryFile(const std::string& content) : descriptor_(memfd_create("fuzz", 0)) {
        if (write(descriptor_, content.data(), content.size()) < 0) descriptor_ = -1;
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::string path() const {
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

  private:
    int descriptor_;
};

}  // namespace stipple
