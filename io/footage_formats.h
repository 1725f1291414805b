#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/geometry.h"
#include "io/fits_reader.h"
#include "io/footage_files.h"
#include "io/footage_reader.h"
#include "io/image.h"
#include "io/npy_file.h"
#include "io/raw_video.h"
#include "io/tiff_file.h"
#include "io/video_reader.h"

namespace stipple {

/// Reads images one after the other.
class ImageSequence {
  public:
    /// Of images, at least one, or of the pages of a file.
    explicit ImageSequence(ImageFiles images, std::optional<TiffFile> tiff = {});

    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] const SourceInfo& traits() const { return traits_; }
    [[nodiscard]] const std::string& warning() const { return images_.warning; }
    /// "TIFF file", "PNG images".
    [[nodiscard]] std::string kind() const;
    [[nodiscard]] int slots() const {
        return tiff_ ? tiff_->pages() : static_cast<int>(images_.files.size());
    }
    [[nodiscard]] std::string where() const {
        return tiff_ ? tiff_->where(next_ - 1)
                     : images_.files[static_cast<std::size_t>(next_ - 1)].string();
    }

    /// The next image; false: there is none. \throws InputError as read_image, and if it differs
    /// from the first one in shape, colour filter array or transfer function.
    bool read(std::span<float> frame);

    /// That images were exposed unequally long, so far; else empty.
    [[nodiscard]] std::string exposure_warning() const;

    void skip(int frames) { next_ += std::min(frames, slots() - next_); }

  private:
    void load(int slot);

    ImageFiles images_;
    std::optional<TiffFile> tiff_;
    TiffPixels page_;
    int next_ = 0;
    double min_exposure_us_ = std::numeric_limits<double>::max();
    double max_exposure_us_ = 0;
    Image image_;
    SourceInfo traits_;
    FrameShape shape_;
};

/// What footage is read with.
using FrameSource = std::variant<ImageSequence, NpyReader, VideoReader, RawVideoReader, FitsReader>;

/// Opens footage by the kind of its name: a folder, a pattern, a file; of `options` only `raw`
/// counts. \throws InputError if there is no such footage, or it is not of a known format.
[[nodiscard]] FrameSource open_source(const std::filesystem::path& source,
                                      const FootageOptions& options);

/// Whether the extension of a file is one of those that are read.
[[nodiscard]] bool is_footage_name(const std::filesystem::path& file);

/// The formats of footage: images, then files with frames. A format has rows in the tables of
/// docs/footage.md, and a fuzz target of its name.
[[nodiscard]] std::vector<std::string_view> footage_format_names();

}  // namespace stipple
