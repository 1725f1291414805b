#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace stipple {

/// A file of known length, of which parts are read.
class RandomAccessFile {
  public:
    /// \throws InputError if it is missing, unreadable, or no regular file.
    explicit RandomAccessFile(const std::filesystem::path& file);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// Fills `bytes` from `offset` on. \throws InputError if the file is too short or unreadable.
    void read(std::uint64_t offset, std::span<std::uint8_t> bytes);

  private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    std::string name_;
    std::unique_ptr<std::FILE, Closer> file_;
    std::uint64_t size_ = 0;
};

}  // namespace stipple
