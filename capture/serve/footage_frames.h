#pragma once

#include <filesystem>
#include <vector>

#include "capture/serve/frame_source.h"
#include "io/footage_reader.h"

namespace stipple {

/// Footage as the frames of a camera without noise: light 1.0 is full scale, DN are rounded to the
/// nearest and clipped. Formats of one plane: Mono8 to Mono16, and "p" formats whose rows are whole
/// bytes; of three planes: RGB8. So 8-bit footage as Mono8 and 16-bit footage as Mono16 keep their
/// numbers. If the preferred format has a colour filter array, one plane is the mosaic behind it,
/// and of three planes each pixel has the colour of its filter. All formats with that array are
/// then offered.
class FootageFrames final : public FrameSource {
  public:
    /// `preferred` becomes the default format; null: Mono8 or RGB8. \throws InputError as
    /// FootageReader, and if the footage does not suit that format.
    FootageFrames(std::filesystem::path footage, const FootageOptions& options, double frames_hz,
                  const PixelFormat* preferred = nullptr);

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    [[nodiscard]] std::optional<ServedFrame> next() override;

  private:
    void make_default(const PixelFormat& format);
    void check_mosaic() const;
    void check_cells() const;

    std::filesystem::path footage_;
    FootageOptions options_;
    FootageReader reader_;
    FrameShape shape_;
    ColourFilter filter_ = ColourFilter::kNone;
    ServedImage image_;
    const PixelFormat* format_ = nullptr;
    std::uint64_t number_ = 0;
    std::vector<float> light_;
    std::vector<float> mosaic_;  ///< colour footage behind a colour filter array
    std::vector<std::uint16_t> dn_;
};

/// Light in the order (plane, row, col) as DN in the order (row, col, plane), 1.0 at 2^bits - 1.
void quantise_light(std::span<const float> light, FrameShape shape, int bits,
                    std::span<std::uint16_t> dn);

}  // namespace stipple
