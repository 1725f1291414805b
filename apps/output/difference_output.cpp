#include "apps/output/difference_output.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "io/footage_files.h"
#include "io/image_file.h"

namespace stipple {

DifferenceOutput::DifferenceOutput(const std::filesystem::path& file, FrameShape shape, bool force,
                                   std::optional<double> max_value)
    : shape_(shape),
      max_value_(static_cast<float>(
          max_value.value_or(static_cast<double>(std::numeric_limits<float>::max())))),
      difference_(shape.sites()) {
    if (lower_extension(file) == ".png") {
        image_.emplace(file, force);
        squares_.resize(shape.sites());
    } else {
        video_ = std::make_unique<FrameWriter>(file, shape, FrameWriterOptions{.force = force});
    }
}

void DifferenceOutput::add(std::span<const float> result, std::span<const float> reference) {
    assert(result.size() == difference_.size() && reference.size() == difference_.size());
    ++frames_;
    for (std::size_t i = 0; i < difference_.size(); ++i)
        difference_[i] =
            std::abs(std::min(result[i], max_value_) - std::min(reference[i], max_value_));
    if (video_) return video_->write(difference_);
    for (std::size_t i = 0; i < difference_.size(); ++i) {
        const auto error = static_cast<double>(difference_[i]);
        squares_[i] += error * error;
    }
}

void DifferenceOutput::finish() {
    if (video_) return video_->finish();
    for (std::size_t i = 0; i < difference_.size(); ++i)
        difference_[i] = static_cast<float>(std::sqrt(squares_[i] / static_cast<double>(frames_)));
    write_png(image_->partial(), image_->final_path().string(), shape_, difference_);
    image_->commit();
}

}  // namespace stipple
