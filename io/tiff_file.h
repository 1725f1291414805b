#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"
#include "core/message.h"

namespace stipple {

/// What a TIFF file holds: its directories, and the samples of the first one, all channels.
struct TiffExtent {
    std::uint64_t pages = 1;
    std::uint64_t channels = 1;
    std::uint64_t page_samples = 1;
};

/// What a description declares of pages that are moments in time.
struct TiffTimes {
    std::optional<double> frames_hz = {};
    std::vector<Message> warnings = {};  ///< without the name of the file
};

/// Reads the ImageDescription of the first page as ImageJ, OME-XML or tifffile write it; nothing is
/// declared by any other. \throws InputError at `where` if pages are channels, focal planes or
/// others than moments in time, or fewer than the description announces.
[[nodiscard]] TiffTimes times_of_pages(std::string_view description, const TiffExtent& extent,
                                       const std::string& where);

/// The pixels of a TIFF page as stored, but interleaved: by row, column and channel.
struct TiffPixels {
    enum class Sample { kU8, kU16, kF32 };

    FrameShape shape;
    Sample sample = Sample::kU8;
    int channels = 1;          ///< planes and alpha
    TiffTimes times;           ///< of all pages of the file
    bool has_profile = false;  ///< of its colours (ICC)
    std::vector<std::byte> bytes;

    [[nodiscard]] std::size_t sample_bytes() const;
};

/// A TIFF file (6.0 or BigTIFF) of grey or RGB pages, in strips or tiles, with interleaved or
/// separate channels. Nothing is written to standard error.
class TiffFile {
  public:
    /// \throws InputError if the file is missing, unreadable or no TIFF, or declares pages that are
    /// no moments in time.
    explicit TiffFile(const std::filesystem::path& file);
    ~TiffFile();
    TiffFile(TiffFile&&) noexcept;
    TiffFile& operator=(TiffFile&&) noexcept;

    [[nodiscard]] int pages() const;
    /// Page 0, 1, ... < pages(). \throws InputError naming the file, and the page if there are
    /// several, if it is damaged or of an unsupported kind.
    void read(int page, TiffPixels& pixels);
    /// The file, and the page if there are several, for messages.
    [[nodiscard]] std::string where(int page) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The only page of a file. \throws InputError as TiffFile, or if there are more.
[[nodiscard]] TiffPixels read_single_tiff(const std::filesystem::path& file);

}  // namespace stipple
