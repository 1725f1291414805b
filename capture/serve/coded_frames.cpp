#include "capture/serve/served_frames.h"

#include <utility>

#include "core/error.h"

namespace stipple {

CodedFrames::CodedFrames(std::filesystem::path footage, const FootageOrigin& origin,
                         const SensorChoice& sensor, std::optional<double> slots_hz)
    : footage_(std::move(footage)),
      reading_(origin.reading),
      reader_(footage_, reading_),
      setup_(set_up_sensor(sensor, reader_.shape(), reader_.filter())),
      header_(coded_header(stream_header_of(setup_, provenance_of(setup_, origin)))),
      image_(coded_image(header_.stream)),
      light_(setup_.footage.sites()) {
    if (slots_hz) image_.frames_hz = *slots_hz;
    if (const auto slots = reader_.slots()) image_.frames = static_cast<std::uint64_t>(*slots);
}

void CodedFrames::start(const PixelFormat&) {
    reader_ = FootageReader(footage_, reading_);
    if (reader_.shape() != setup_.footage)
        throw InputError(footage_.string(), "has changed its size while it was served");
    emulator_.emplace(setup_);
    slot_ = 0;
}

std::optional<ServedFrame> CodedFrames::next() {
    if (!reader_.read(light_)) return {};
    ServedFrame frame;
    frame.payload = coded_payload(emulator_->expose(light_), header_, image_);
    frame.number = slot_++;
    return frame;
}

}  // namespace stipple
