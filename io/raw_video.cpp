#include "io/raw_video.h"

#include <fmt/format.h>

#include <cassert>
#include <limits>
#include <utility>

#include "core/error.h"
#include "io/pixel_format.h"

namespace stipple {

RawVideoReader::RawVideoReader(RawVideo video) : video_(std::move(video)), file_(video_.file) {
    assert(video_.offsets.empty() || video_.offsets.size() == video_.slots);
    const auto fits = [this](std::uint64_t offset, std::uint64_t bytes) {
        return offset <= file_.size() && bytes <= file_.size() - offset;
    };
    if (video_.slots > std::numeric_limits<int>::max())
        throw InputError(file_.name(), fmt::format("announces {} frames", video_.slots));
    const std::uint64_t bytes = video_.frame_bytes();
    if (video_.offsets.empty() && video_.slots > 0 &&
        (!fits(video_.first_offset, bytes) ||
         video_.slots - 1 > (file_.size() - video_.first_offset - bytes) / step()))
        throw InputError(
            file_.name(),
            fmt::format("has {} bytes, but {} frames of {} bytes from byte {} on are announced; it "
                        "is damaged or cut short",
                        file_.size(), video_.slots, bytes, video_.first_offset));
    for (std::size_t i = 0; i < video_.offsets.size(); ++i)
        if (!fits(video_.offsets[i], bytes))
            throw InputError(fmt::format("{}: frame {}", file_.name(), i),
                             fmt::format("begins at byte {} and takes {} bytes, but the file has "
                                         "{}; it is damaged or cut short",
                                         video_.offsets[i], bytes, file_.size()));
    bytes_.resize(bytes);
    samples_.resize(static_cast<std::size_t>(video_.shape.cols) *
                    static_cast<std::size_t>(video_.shape.planes));
}

std::string RawVideoReader::where() const {
    return fmt::format("{}: frame {}", file_.name(), next_slot_ - 1);
}

std::uint64_t RawVideoReader::offset_of(std::uint64_t slot) {
    if (video_.offsets.empty()) return video_.first_offset + slot * step();
    const std::uint64_t offset = video_.offsets[slot];
    if (!video_.annotated) return offset;
    const auto number_at = [this](std::uint64_t at) {
        std::uint32_t number = 0;
        file_.read(at, {reinterpret_cast<std::uint8_t*>(&number), sizeof(number)});
        return number;
    };
    constexpr std::uint32_t kMinLength = 8;  // itself, and at its end the length of the frame
    const std::uint32_t length = number_at(offset);
    const std::uint32_t announced =
        length < kMinLength ? 0 : number_at(offset + length - sizeof(announced));
    if (announced != bytes_.size())
        throw InputError(where(), fmt::format("announces {} bytes, but a frame of its size has {}; "
                                              "it is damaged or compressed",
                                              announced, bytes_.size()));
    return offset + length;
}

bool RawVideoReader::read(std::span<float> frame) {
    if (next_slot_ == video_.slots) return false;
    file_.read(offset_of(next_slot_++), bytes_);
    const std::size_t row_bytes = video_.format.row_bytes(video_.shape.cols);
    const auto rows = static_cast<std::size_t>(video_.shape.rows);
    const auto cols = static_cast<std::size_t>(video_.shape.cols);
    const auto planes = static_cast<std::size_t>(video_.shape.planes);
    for (std::size_t row = 0; row < rows; ++row) {
        const std::size_t stored = video_.bottom_up ? rows - 1 - row : row;
        unpack_row(video_.format, std::span(bytes_).subspan(stored * row_bytes, row_bytes),
                   samples_);
        for (std::size_t plane = 0; plane < planes; ++plane) {
            float* const light = &frame[(plane * rows + row) * cols];
            for (std::size_t col = 0; col < cols; ++col)
                light[col] = video_.light_of_dn[samples_[col * planes + plane]];
        }
    }
    return true;
}

}  // namespace stipple
