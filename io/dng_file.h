#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "io/image.h"
#include "io/tiff_handle.h"

namespace stipple {

/// Decodes a lossless JPEG image (ITU-T T.81, process 14: Huffman codes, predictors 1 to 7) into
/// its samples, row after row, components interleaved. Not supported: restart intervals and
/// subsampled components.
/// \throws InputError at `where` if it is damaged, of another process, or does not have
/// samples.size() samples of 2 to 16 bits.
void decode_lossless_jpeg(std::span<const std::uint8_t> jpeg, const std::string& where,
                          std::span<std::uint16_t> samples);

/// A rectangle of pixels.
struct DngArea {
    std::uint32_t top = 0;
    std::uint32_t left = 0;
    std::uint32_t bottom = 0;
    std::uint32_t right = 0;
};

/// What the directory of a raw image declares.
struct DngPage {
    std::uint32_t rows = 0;
    std::uint32_t cols = 0;
    int bits = 0;
    std::uint16_t photometric = 0;
    std::uint16_t compression = 0;
    DngArea area;  ///< of the pixels that see light
    ColourFilter filter = ColourFilter::kNone;
    std::vector<std::uint16_t> linear;  ///< of each stored number; empty: itself
    std::uint16_t black_rows = 1;       ///< of the pattern of black levels, from the area's corner
    std::uint16_t black_cols = 1;
    std::vector<float> black_dn;
    std::vector<float> black_of_row;  ///< added to it; empty: 0
    std::vector<float> black_of_col;
    double white_dn = 0;

    /// \throws InputError if it is none that can be read.
    DngPage(tiff* file, const std::string& name);

    /// At a place of the area.
    [[nodiscard]] double black_at(std::uint32_t row, std::uint32_t col) const;
    /// The one black level, if it is one.
    [[nodiscard]] bool has_one_black() const;

  private:
    void read_levels(tiff* file, const std::string& name);
    void check_kind(tiff* file, const std::string& name) const;
};

/// Goes to the raw image, which is the first directory or one below it. \throws InputError if there
/// is none.
void find_raw(const TiffHandle& handle);

/// Adds rate and exposure, from the first directory, where libtiff is afterwards.
void read_dng_camera(const TiffHandle& handle, SourceInfo& traits);

/// Adds warnings of what the directory at hand declares and is not applied.
void add_dng_warnings(tiff* file, SourceInfo& traits);

/// Reads the raw image of a .dng file (DNG 1.4, CinemaDNG): grey or the mosaic of a colour filter
/// array, 8 to 16 bits, not compressed or by Deflate, its active area. Light is 0 at the black and
/// 1 at the white level of the file. \throws InputError if it is damaged or of another kind.
void read_dng(const std::filesystem::path& file, Image& image);

}  // namespace stipple
