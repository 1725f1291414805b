#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"
#include "io/file_bytes.h"
#include "io/image.h"

namespace stipple {

/// True if the extension is .fits, .fit or .fts.
[[nodiscard]] bool is_fits_name(const std::filesystem::path& file);

/// Reads the primary array of a FITS file (FITS Standard 4.0), or if that is empty, its one image
/// extension, of 2 axes as one frame or of 3 as a cube of frames. Numbers of 8 and 16 bits are
/// light 1.0 at their highest value (255; 65535 with BZERO = 32768, else 32767); scaled, longer and
/// floating-point ones are light as they are. The first row of the array is the last of the frame,
/// unless ROWORDER = 'TOP-DOWN'.
class FitsReader {
  public:
    /// \throws InputError if the file is damaged or too short, or its array is of a kind that is
    /// not read.
    explicit FitsReader(const std::filesystem::path& file);

    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] int slots() const { return slots_; }
    [[nodiscard]] const SourceInfo& traits() const { return traits_; }
    /// The file and the frame read last, for messages.
    [[nodiscard]] std::string where() const;

    /// The next frame, by row and column; false at the end. \throws InputError.
    bool read(std::span<float> frame);
    void skip(int frames) { next_slot_ += std::min(frames, slots_ - next_slot_); }

  private:
    RandomAccessFile file_;
    FrameShape shape_;
    SourceInfo traits_;
    std::uint64_t data_offset_ = 0;
    int bits_ = 0;     ///< of a number: 8, 16, 32, 64; negative of floating-point ones
    double zero_ = 0;  ///< light = zero_ + scale_ * number
    double scale_ = 1;
    std::optional<double> blank_;  ///< number without a value
    bool top_down_ = false;
    int slots_ = 0;
    int next_slot_ = 0;
    std::vector<std::uint8_t> bytes_;
};

}  // namespace stipple
