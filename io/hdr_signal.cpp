#include "io/hdr_signal.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/parallel.h"

namespace stipple {

HdrSignal::HdrSignal(FrameShape shape, const VideoCoding& coding)
    : shape_(shape),
      curve_(coding.curve),
      scale_(static_cast<float>(curve_ == VideoCurve::kPq
                                    ? coding.cd_per_unit
                                    : hlg_light_of_luminance(coding.cd_per_unit))),
      peak_(curve_ == VideoCurve::kPq ? static_cast<float>(coding.peak_cd) : 1.0F),
      light_(shape.sites()),
      rows_(static_cast<std::size_t>(shape.rows)) {
    assert(curve_ != VideoCurve::kSdr);
}

void HdrSignal::convert(std::span<const float> frame, std::span<std::uint16_t> pixels) {
    assert(frame.size() == shape_.sites() && pixels.size() == shape_.sites());
    std::ranges::transform(frame, light_.begin(), [](float v) { return v > 0.0F ? v : 0.0F; });
    if (shape_.planes == 3) bt709_to_bt2020(light_);
    parallel_for(0, shape_.rows,
                 [&](int row) { rows_[static_cast<std::size_t>(row)] = convert_row(row, pixels); });
    RowSums all;
    for (const RowSums& row : rows_) {
        all.max = std::max(all.max, row.max);
        all.sum += row.sum;
        clipped_ += row.clipped;
    }
    values_ += static_cast<double>(shape_.sites());
    max_ = std::max(max_, static_cast<double>(all.max));
    max_mean_ = std::max(max_mean_, all.sum / static_cast<double>(shape_.pixels()));
}

HdrSignal::RowSums HdrSignal::convert_row(int row, std::span<std::uint16_t> pixels) {
    const auto cols = static_cast<std::size_t>(shape_.cols);
    const auto planes = static_cast<std::size_t>(shape_.planes);
    const std::size_t begin = static_cast<std::size_t>(row) * cols;
    RowSums sums;
    for (std::size_t pixel = begin; pixel < begin + cols; ++pixel) {
        float max = 0;
        for (std::size_t plane = 0; plane < planes; ++plane) {
            const float wanted = scale_ * light_[plane * shape_.pixels() + pixel];
            const float value = std::min(wanted, peak_);
            if (wanted > peak_) ++sums.clipped;
            const float signal = curve_ == VideoCurve::kPq ? pq_signal(value) : hlg_signal(value);
            pixels[pixel * planes + plane] = static_cast<std::uint16_t>(65535.0F * signal + 0.5F);
            max = std::max(max, value);
        }
        sums.max = std::max(sums.max, max);
        sums.sum += static_cast<double>(max);
    }
    return sums;
}

LightLevels HdrSignal::levels() const {
    return {.max_cll = max_,
            .max_fall = max_mean_,
            .clipped_fraction = values_ > 0 ? clipped_ / values_ : 0};
}

}  // namespace stipple
