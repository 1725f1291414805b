#include "apps/read_ahead.h"

#include <utility>

namespace stipple {

ReadAhead::ReadAhead(const std::filesystem::path& source, const FootageOptions& options)
    : reader_(source, options), current_(shape().sites()), coming_(shape().sites()) {
    start_reading();
}

void ReadAhead::start_reading() {
    reading_ = std::async(std::launch::async, [this] { return reader_.read(coming_); });
}

std::span<const float> ReadAhead::next() {
    if (!reading_.valid() || !reading_.get()) return {};
    std::swap(current_, coming_);
    start_reading();
    return current_;
}

}  // namespace stipple
