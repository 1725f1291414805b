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

/// An emulated sensor as a source of frames: each is the packets of one slot (coded_payload.h), the
/// bytes that `emulate` would write. The frame number is the slot. A start resets the sensor, so
/// every client gets the same bits.
class CodedFrames final : public FrameSource {
  public:
    /// Light of the files of `origin`, which lie at `footage`. Without a rate, that of the sensor's
    /// slots. \throws InputError as FootageReader and set_up_sensor.
    CodedFrames(std::filesystem::path footage, const FootageOrigin& origin,
                const SensorChoice& sensor, std::optional<double> slots_per_s);

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
