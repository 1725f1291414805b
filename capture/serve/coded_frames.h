#pragma once

#include <filesystem>
#include <optional>
#include <vector>

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

}  // namespace stipple
