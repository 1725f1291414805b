#include "capture/recording/read_ahead.h"

#include <fmt/format.h>

#include <utility>

#include "core/memory_limit.h"

namespace stipple {
namespace {

std::variant<FootageReader, RecordingFootage> open_footage(const std::filesystem::path& source,
                                                           const FootageOptions& options) {
    if (!is_recording(source))
        return std::variant<FootageReader, RecordingFootage>(std::in_place_type<FootageReader>,
                                                             source, options);
    check_recording_options(source, options);
    return std::variant<FootageReader, RecordingFootage>(std::in_place_type<RecordingFootage>,
                                                         source);
}

}  // namespace

ReadAhead::ReadAhead(const std::filesystem::path& source, const FootageOptions& options,
                     std::function<void(const Message&)> warn)
    : warn_(std::move(warn)), reader_(open_footage(source, options)) {
    constexpr std::uint64_t kSiteBytes = 18;  // two frames here, and what works on them
    check_memory(kSiteBytes * shape().sites(), source.string(),
                 fmt::format("frames of {} x {}", shape().cols, shape().rows), input_bytes(source));
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    has_times_ = footage != nullptr && footage->has_times();
    current_.resize(shape().sites());
    coming_.resize(shape().sites());
    pass_warnings_on();
    start_reading();
}

void ReadAhead::pass_warnings_on() {
    if (auto* const footage = std::get_if<FootageReader>(&reader_))
        for (const Message& warning : footage->take_warnings()) warn_(warning);
}

bool ReadAhead::gamma_coded() const {
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    return footage != nullptr && footage->gamma_coded();
}

FrameShape ReadAhead::shape() const {
    return std::visit([](const auto& reader) { return reader.shape(); }, reader_);
}

std::optional<int> ReadAhead::slots() const {
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    return footage == nullptr ? std::nullopt : footage->slots();
}

std::optional<double> ReadAhead::frames_hz() const {
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    return footage == nullptr ? std::nullopt : footage->frames_hz();
}

std::optional<double> ReadAhead::exposure_us() const {
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    return footage == nullptr ? std::nullopt : footage->exposure_us();
}

SourceInfo ReadAhead::traits() const {
    const auto* const footage = std::get_if<FootageReader>(&reader_);
    return footage == nullptr ? SourceInfo{} : footage->traits();
}

ColourFilter ReadAhead::filter() const {
    return std::visit([](const auto& reader) { return reader.filter(); }, reader_);
}

const RecordingFootage* ReadAhead::recording() const {
    return std::get_if<RecordingFootage>(&reader_);
}

void ReadAhead::start_reading() {
    reading_ = std::async(std::launch::async, [this] {
        return std::visit([this](auto& reader) { return reader.read(coming_); }, reader_);
    });
}

std::span<const float> ReadAhead::next() {
    const bool has_frame = reading_.valid() && reading_.get();
    pass_warnings_on();
    if (!has_frame) return {};
    if (has_times_) time_ = std::get<FootageReader>(reader_).frame_time();
    std::swap(current_, coming_);
    start_reading();
    return current_;
}

void ReadAhead::skip(int frames) {
    if (frames < 1) return;
    const bool has_frame = reading_.valid() && reading_.get();  // the first of them is being read
    pass_warnings_on();
    if (!has_frame) return;
    if (auto* const footage = std::get_if<FootageReader>(&reader_))
        footage->skip(frames - 1);
    else
        for (int i = 1; i < frames && std::get<RecordingFootage>(reader_).read(coming_); ++i) {
        }
    start_reading();
}

}  // namespace stipple
