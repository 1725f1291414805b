#include "io/npy_file.h"

#include <bit>
#include <cstddef>
#include <string>
#include <utility>

namespace stipple {

static_assert(std::endian::native == std::endian::little, ".npy data are written as they lie");

NpyWriter::NpyWriter(const std::filesystem::path& file, std::string_view where, FrameShape shape,
                     std::string comment)
    : file_(file, std::string(where)), shape_(shape), comment_(std::move(comment)) {
    write_header();
}

void NpyWriter::write_header() {
    const std::string header = format_npy_header(slots_, shape_, comment_);
    file_.seek(0);
    file_.write(std::as_bytes(std::span(header)));
    file_.seek(static_cast<long>(header.size() + static_cast<std::size_t>(slots_) * shape_.sites() *
                                                     sizeof(float)));
    header_slots_ = slots_;
    header_time_ = Clock::now();
}

void NpyWriter::write(std::span<const float> frame) {
    const auto planes = static_cast<std::size_t>(shape_.planes);
    pixels_.resize(shape_.sites());
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t i = 0; i < shape_.pixels(); ++i)
            pixels_[i * planes + plane] = frame[plane * shape_.pixels() + i];
    file_.write(std::as_bytes(std::span(pixels_)));
    ++slots_;
    if (slots_ >= 2 * header_slots_ || Clock::now() - header_time_ >= std::chrono::seconds(1))
        write_header();
}

void NpyWriter::finish() {
    write_header();
    file_.close();
}

}  // namespace stipple
