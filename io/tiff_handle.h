#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

struct tiff;  // of libtiff

namespace stipple {

/// A TIFF file that libtiff reads. It writes nothing to standard error.
class TiffHandle {
  public:
    /// \throws InputError if the file is missing, unreadable or no TIFF.
    explicit TiffHandle(const std::filesystem::path& file);
    TiffHandle(const TiffHandle&) = delete;
    TiffHandle& operator=(const TiffHandle&) = delete;

    [[nodiscard]] tiff* get() const { return tiff_.get(); }
    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::uint64_t file_bytes() const { return file_bytes_; }
    /// Before memory is taken for the page at hand, whose pixels are `stored` bytes and take
    /// `taken` bytes. A tile may be larger than the page, so it counts too. \throws InputError at
    /// `where` if the file cannot hold as many with a compression ratio of `ratio`, or if they
    /// exceed `max_memory`.
    void check_size(std::uint64_t stored, std::uint64_t taken, std::uint64_t ratio,
                    const std::string& where) const;
    void forget_message() { message_.clear(); }
    /// \throws InputError with the first message of libtiff since it was forgotten.
    [[noreturn]] void fail(const std::string& where) const;

  private:
    struct Closer {
        void operator()(tiff* file) const;
    };

    std::string name_;
    std::string message_;
    std::uint64_t file_bytes_ = 0;
    std::unique_ptr<tiff, Closer> tiff_;
};

}  // namespace stipple
