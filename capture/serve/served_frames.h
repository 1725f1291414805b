#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "capture/recording/recording_reader.h"
#include "capture/serve/coded_payload.h"
#include "capture/serve/frame_source.h"
#include "io/footage_reader.h"
#include "readout/emulator.h"
#include "readout/provenance.h"

namespace stipple {

/// An emulated sensor as a source of frames. Each frame is the packets of one slot
/// (coded_payload.h), with the same bytes as `emulate` writes. The frame number is the slot. A
/// start resets the sensor, so every client gets the same bits.
class CodedFrames final : public FrameSource {
  public:
    /// The light comes from `footage`, the files of `origin`. The default rate is the slot rate of
    /// the sensor. \throws InputError as FootageReader and set_up_sensor.
    CodedFrames(std::filesystem::path footage, const FootageOrigin& origin,
                const SensorChoice& sensor, std::optional<double> slots_hz);

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    [[nodiscard]] std::optional<ServedFrame> next() override;

  private:
    std::filesystem::path footage_;
    FootageOptions reading_;
    FootageReader reader_;
    SensorSetup setup_;
    CodedHeader header_;
    ServedImage image_;
    std::optional<Emulator> emulator_;
    std::vector<float> light_;
    std::uint64_t slot_ = 0;
};

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

/// A recording as the frames of a camera, with the same bytes and device stamps. Frame numbers skip
/// missing and incomplete frames, so clients count them as lost.
class RecordingFrames final : public FrameSource {
  public:
    /// The default rate is that of the stamps. \throws InputError as RecordingReader, if there is
    /// no complete frame, or if GigE Vision has no such format.
    explicit RecordingFrames(const std::filesystem::path& file,
                             std::optional<double> frames_hz = {});

    [[nodiscard]] const ServedImage& image() const override { return image_; }
    void start(const PixelFormat& format) override;
    /// \throws InputError for a frame with another layout than the first.
    [[nodiscard]] std::optional<ServedFrame> next() override;

  private:
    [[nodiscard]] bool read_complete(CapturedFrame& frame);
    [[nodiscard]] double recorded_rate(const FrameRecord& first);

    std::filesystem::path file_;
    RecordingReader reader_;
    ServedImage image_;
    FrameLayout layout_;
    std::uint64_t first_id_ = 0;
};

}  // namespace stipple
