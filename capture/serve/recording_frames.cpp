#include "capture/serve/served_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "capture/frame_sequence.h"
#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

void check_format(const FrameLayout& layout, const std::string& where) {
    const PixelFormat& format = *layout.format;
    if (format.pfnc == 0)
        throw InputError(where, fmt::format("{} has no number in GigE Vision, so it cannot be "
                                            "served; use \"stipple capture replay\"",
                                            format.name));
    if (layout.width * format.bits_per_pixel % 8 != 0)
        throw InputError(where, fmt::format("rows of {} pixels of {} are not whole bytes, so they "
                                            "cannot be served",
                                            layout.width, format.name));
}

/// Takes out what pads the rows.
void remove_padding(std::vector<std::uint8_t>& payload, const FrameLayout& layout) {
    const std::size_t row_bytes = layout.format->row_bytes(layout.width);
    const auto rows = static_cast<std::size_t>(layout.height);
    for (std::size_t row = 1; row < rows; ++row)
        std::copy_n(payload.begin() + static_cast<std::ptrdiff_t>(row * layout.stride_bytes),
                    row_bytes, payload.begin() + static_cast<std::ptrdiff_t>(row * row_bytes));
    payload.resize(rows * row_bytes);
}

}  // namespace

RecordingFrames::RecordingFrames(const std::filesystem::path& file, std::optional<double> frames_hz)
    : file_(file), reader_(file) {
    CapturedFrame first;
    if (!read_complete(first)) throw InputError(file.string(), "holds no complete frame");
    layout_ = first.record.layout;
    first_id_ = first.record.id;
    check_format(layout_, file.string());
    image_.width = layout_.width;
    image_.height = layout_.height;
    image_.formats = {layout_.format};
    image_.frames_hz = frames_hz ? *frames_hz : recorded_rate(first.record);
}

/// By the frame that follows the first.
double RecordingFrames::recorded_rate(const FrameRecord& first) {
    CapturedFrame next;
    if (first.stamp_source == StampSource::kNone || !read_complete(next))
        return ServedImage::kUsualFramesHz;
    FrameRate frames;
    frames.add(first);
    frames.add(next.record);
    const double rate = frames.hz().value_or(0);
    const bool usable = rate >= ServedImage::kMinFramesHz && rate <= ServedImage::kMaxFramesHz;
    return usable ? rate : ServedImage::kUsualFramesHz;
}

bool RecordingFrames::read_complete(CapturedFrame& frame) {
    while (reader_.next(frame))
        if (frame.record.status == FrameStatus::kComplete &&
            frame.payload.size() == frame.record.layout.payload_bytes())
            return true;
    return false;
}

void RecordingFrames::start(const PixelFormat&) {
    reader_.rewind();
}

std::optional<ServedFrame> RecordingFrames::next() {
    CapturedFrame frame;
    if (!read_complete(frame)) {
        if (const auto faults = reader_.faults(); !faults.empty())
            warn(fmt::format("{}: {}", file_.string(), joined(faults)));
        return {};
    }
    const FrameRecord& record = frame.record;
    if (record.layout != layout_)
        throw InputError(file_.string(),
                         fmt::format("frame {} has another layout than the first; a served camera "
                                     "keeps one",
                                     record.id));
    ServedFrame served;
    served.number = record.id - first_id_;
    if (record.stamp_source != StampSource::kNone)
        served.stamp_ns = static_cast<std::uint64_t>(record.device_ns);
    remove_padding(frame.payload, layout_);
    served.payload = std::move(frame.payload);
    return served;
}

}  // namespace stipple
