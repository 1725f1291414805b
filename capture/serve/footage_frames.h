#pragma once

#include <filesystem>
#include <vector>

#include "capture/serve/frame_source.h"
#include "core/footage_reader.h"

namespace stipple {

/// Footage as the frames of a camera without noise: light 1.0 is full scale, DN are rounded to the
/// nearest and clipped. One plane can be had as Mono8, Mono10, Mono10p, Mono12, Mono12p and Mono16
/// (packed ones if rows are whole bytes), three as RGB8. So 8-bit footage as Mono8 and 16-bit
/// footage as Mono16 keep their numbers.
class FootageFrames final : public FrameSource {
  public:
    /// `preferred` becomes the default format; null: Mono8 or RGB8. \throws InputError as
    /// FootageReader, and if the footage cannot be had in that format.
    FootageFrames(std::filesystem::path footage, const FootageOptions& options, double frames_per_s,
                  const PixelFormat* preferred = nullptr);

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    [[nodiscard]] std::optional<ServedFrame> next() override;

  private:
    void make_default(const PixelFormat& format);

    std::filesystem::path footage_;
    FootageOptions options_;
    FootageReader reader_;
    FrameShape shape_;
    ServedImage image_;
    const PixelFormat* format_ = nullptr;
    std::uint64_t number_ = 0;
    std::vector<float> light_;
    std::vector<std::uint16_t> dn_;
};

/// Light in the order (plane, row, col) as DN in the order (row, col, plane), 1.0 at 2^bits - 1.
void quantise_light(std::span<const float> light, FrameShape shape, int bits,
                    std::span<std::uint16_t> dn);

}  // namespace stipple
