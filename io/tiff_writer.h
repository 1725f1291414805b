#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/geometry.h"
#include "io/frame_coding.h"

namespace stipple {

/// Writes a TIFF file without compression: float or 16-bit integers, grey or RGB interleaved.
class TiffWriter {
  public:
    enum class Kind {
        kImage,  ///< one page, TIFF 6.0
        kStack,  ///< OME-TIFF: a page for each frame, BigTIFF, OME-XML in the first page
    };
    /// Creates `file`; messages name it `where`. Precondition: coding.samples is kFloat or kWord.
    /// \throws DeviceError.
    TiffWriter(const std::filesystem::path& file, const std::string& where, FrameShape shape,
               const ImageCoding& coding, Kind kind = Kind::kStack);
    ~TiffWriter();
    TiffWriter(TiffWriter&&) noexcept;
    TiffWriter& operator=(TiffWriter&&) noexcept;

    /// `frame` holds shape.sites() floats, order (plane, row, col). \throws DeviceError.
    void write(std::span<const float> frame);
    /// Completes the file. \throws DeviceError.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The OME-XML of a stack: sizes, type of the numbers, seconds between the frames, size of a pixel.
[[nodiscard]] std::string ome_xml(FrameShape shape, int slots, const ImageCoding& coding);

}  // namespace stipple
