#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace stipple {

/// A file in memory that is read through a path: thousands of them cost no disk.
class MemoryFile {
  public:
    explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("stipple", 0)) {
        good_ = write(descriptor_, bytes.data(), bytes.size()) == std::ssize(bytes);
    }
    explicit MemoryFile(std::span<const std::uint8_t> bytes)
        : MemoryFile({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) {}
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

/// The same under a name with an extension, for what is read by its kind.
class NamedMemoryFile {
  public:
    NamedMemoryFile(std::span<const std::uint8_t> bytes, std::string_view extension)
        : file_(bytes),
          name_(std::filesystem::temp_directory_path() /
                ("stipple_fuzz_" + std::to_string(getpid()) + std::string(extension))) {
        std::filesystem::remove(name_);  // of a run that crashed
        std::filesystem::create_symlink(file_.path(), name_);
    }
    ~NamedMemoryFile() {
        std::error_code ignored;
        std::filesystem::remove(name_, ignored);
    }
    NamedMemoryFile(const NamedMemoryFile&) = delete;
    NamedMemoryFile& operator=(const NamedMemoryFile&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return name_; }

  private:
    MemoryFile file_;
    std::filesystem::path name_;
};

}  // namespace stipple
