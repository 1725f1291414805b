#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/slot_emulator.h"
#include "capture/serve/coded_payload.h"
#include "capture/serve/frame_source.h"
#include "io/footage_reader.h"

namespace stipple {

/// An emulated sensor as a source of frames: each is the packets of one slot (coded_payload.h), the
/// bytes that `emulate` would write. The frame number is the slot. A start resets the sensor, so
/// every client gets the same bits.
class CodedFrames final : public FrameSource {
  public:
    /// Without a rate, that of the sensor's slots. \throws InputError as `emulate`.
    CodedFrames(const std::string& footage, const FootageOptions& reading,
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
    std::optional<SlotEmulator> emulator_;
    std::vector<float> light_;
    std::uint64_t slot_ = 0;
};

}  // namespace stipple
