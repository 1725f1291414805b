#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stipple {

/// A file or a pipe, read from front to back through a window of memory. It is read, not mapped:
/// if another program shortens the file or the disk fails, the result is an end or an error, not a
/// SIGBUS.
class BufferedReader {
  public:
    /// Behaviour of a read from an empty pipe.
    enum class EmptyPipe { kWait, kReturn };

    /// Does not wait for the writer of a pipe. \throws InputError naming the file if it cannot be
    /// opened.
    explicit BufferedReader(const std::filesystem::path& file,
                            EmptyPipe empty_pipe = EmptyPipe::kWait);
    ~BufferedReader();
    BufferedReader(const BufferedReader&) = delete;
    BufferedReader& operator=(const BufferedReader&) = delete;

    /// Offset in the file of the first byte of the window.
    [[nodiscard]] std::uint64_t offset() const { return offset_; }
    /// Bytes of the file that have been read, those of the window included.
    [[nodiscard]] std::uint64_t bytes_read() const { return offset_ + (end_ - begin_); }
    /// The next `bytes` bytes. Fewer at the end of the file or of the present content of a pipe;
    /// more may follow later. Valid until the next call. Memory is taken only for bytes that the
    /// file has. \throws InputError if the file cannot be read, or if a signal that the program
    /// handles comes while it waits for a pipe.
    [[nodiscard]] std::span<const std::uint8_t> peek(std::size_t bytes);
    /// Moves on. Precondition: `bytes` bytes have been peeked at.
    void skip(std::size_t bytes);
    /// Moves to an offset of the file. Precondition: it is no pipe, and long enough.
    /// \throws InputError if the system does not allow it.
    void seek(std::uint64_t offset);

    /// Length of the file; nothing if it is a pipe.
    [[nodiscard]] std::optional<std::uint64_t> file_bytes() const;
    /// `bytes` bytes at `offset`; nothing if the file does not have them. Does not move the window.
    [[nodiscard]] std::optional<std::vector<std::uint8_t>> read_at(std::uint64_t offset,
                                                                   std::size_t bytes) const;

  private:
    [[noreturn]] void fail() const;
    void make_room(std::size_t bytes);
    /// 0 at the end.
    [[nodiscard]] std::size_t read_some(std::uint8_t* to, std::size_t bytes);

    std::string where_;
    int descriptor_;
    bool is_pipe_ = false;
    bool waits_;
    std::uint64_t offset_ = 0;
    std::vector<std::uint8_t> buffer_;
    std::size_t begin_ = 0;  ///< the window is buffer_[begin_ .. end_)
    std::size_t end_ = 0;
};

}  // namespace stipple
