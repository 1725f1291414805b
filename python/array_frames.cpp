#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "core/light.h"
#include "io/footage_warnings.h"
#include "io/interleaved.h"
#include "python/bindings.h"
#include "python/footage.h"

namespace stipple::python {
namespace {

struct Cast {
    template <typename Value>
    float operator()(Value value) const {
        return static_cast<float>(value);
    }
};

constexpr const char* kWhere = "video";

/// In the byte order of the machine, and half floats as floats, which hold them exactly.
py::array readable(const py::array& array) {
    const char kind = array.dtype().kind();
    const auto bytes = array.itemsize();
    if (kind == 'f' && bytes == 2) return py::array_t<float>(array);
    const bool known = kind == 'f' ? bytes == 4 || bytes == 8 : kind == 'u' && bytes <= 2;
    if (!known)
        throw InputError(kWhere,
                         fmt::format("has dtype {}; give floating-point light, or uint8 or uint16",
                                     std::string(py::str(array.dtype()))));
    if (array.dtype().attr("isnative").cast<bool>()) return array;
    return array.attr("astype")(array.dtype().attr("newbyteorder")("="));
}

FrameShape shape_of(const py::array& array) {
    const auto size = [&](int axis) { return static_cast<std::uint64_t>(array.shape(axis)); };
    if (array.ndim() != 3 && array.ndim() != 4)
        throw InputError(kWhere, fmt::format("has {} axes; give (slot, row, col) or (slot, row, "
                                             "col, plane)",
                                             array.ndim()));
    if (array.shape(0) == 0) throw InputError(kWhere, "holds no frame");
    return checked_shape(size(1), size(2), array.ndim() == 4 ? size(3) : 1, kWhere);
}

/// Whether the frames are float32, one plane after the other.
bool are_planar(const py::array& array, FrameShape shape) {
    constexpr auto kFloat = static_cast<py::ssize_t>(sizeof(float));
    const auto address = reinterpret_cast<std::uintptr_t>(array.data());
    return array.dtype().kind() == 'f' && array.itemsize() == kFloat &&
           array.strides(2) == kFloat && array.strides(1) == kFloat * shape.cols &&
           (array.ndim() == 3 ||
            array.strides(3) == kFloat * static_cast<py::ssize_t>(shape.pixels())) &&
           address % sizeof(float) == 0 && array.strides(0) % kFloat == 0;
}

}  // namespace

ArrayFrames::ArrayFrames(const py::array& array, const FootageOptions& options)
    : array_(readable(array)),
      options_(options),
      source_(shape_of(array_)),
      kind_(array_.dtype().kind()),
      contiguous_(are_planar(array_, source_)) {
    if (options.luminance && source_.planes == 3) luminance_.resize(source_.pixels());
    if (options.raw) throw InputError(kWhere, "is an array; raw describes a file");
}

FrameShape ArrayFrames::shape() const {
    return luminance_.empty() ? source_ : FrameShape{source_.rows, source_.cols, 1};
}

template <typename Sample>
void ArrayFrames::take(const std::byte* frame) {
    using Scale = std::conditional_t<std::is_integral_v<Sample>, UnitScale, Cast>;
    const py::ssize_t plane_step = array_.ndim() == 4 ? array_.strides(3) : 0;
    auto to = frame_.begin();
    for (int plane = 0; plane < source_.planes; ++plane)
        for (int row = 0; row < source_.rows; ++row) {
            const std::byte* from = frame + plane * plane_step + row * array_.strides(1);
            for (int col = 0; col < source_.cols; ++col, from += array_.strides(2)) {
                Sample sample;
                std::memcpy(&sample, from, sizeof(sample));
                *to++ = Scale()(sample);
            }
        }
}

std::span<const float> ArrayFrames::stored(const std::byte* frame) {
    if (contiguous_) return {reinterpret_cast<const float*>(frame), source_.sites()};
    frame_.resize(source_.sites());
    if (kind_ == 'f')
        array_.itemsize() == 4 ? take<float>(frame) : take<double>(frame);
    else
        array_.itemsize() == 1 ? take<std::uint8_t>(frame) : take<std::uint16_t>(frame);
    return frame_;
}

std::span<float> ArrayFrames::own(std::span<const float> light) {
    if (light.data() != frame_.data()) frame_.assign(light.begin(), light.end());
    return frame_;
}

std::span<const float> ArrayFrames::next() {
    if (slot_ == slots()) return {};
    const auto* first = static_cast<const std::byte*>(array_.data());
    auto light = stored(first + slot_ * array_.strides(0));
    const std::string where = fmt::format("{}: frame {}", kWhere, slot_++);
    const Transfer transfer = options_.transfer.value_or(Transfer::kLinear);
    if (transfer != Transfer::kLinear && transfer != Transfer::kAuto) {  // arrays declare none
        linearise(own(light), transfer);
        light = frame_;
    }
    check_light(light, source_, where, options_.negative || options_.min_value.has_value());
    if (options_.scale != 1) {
        scale_light(own(light), options_.scale, where);
        light = frame_;
    } else if (slot_ == 1 && !options_.max_value) {
        warning_ = brightness_warning(light, where);
    }
    if (!luminance_.empty()) {
        reduce_to_luminance(light, luminance_);
        light = luminance_;
    }
    if (options_.min_value || options_.max_value) {
        constexpr float kMax = std::numeric_limits<float>::max();
        const auto min = static_cast<float>(options_.min_value.value_or(-kMax));
        const auto max = static_cast<float>(options_.max_value.value_or(kMax));
        const auto clip = [=](float& value) { value = std::min(std::max(value, min), max); };
        const std::span<float> clipped = luminance_.empty() ? own(light) : std::span(luminance_);
        std::ranges::for_each(clipped, clip);
        light = clipped;
    }
    return light;
}

}  // namespace stipple::python
