#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// Several versions of one frame beside one another, each under its name.
class SideBySide {
  public:
    SideBySide(FrameShape shape, const std::vector<std::string>& names);

    /// Puts in `frame` (order (plane, row, col)) as the version of names[version].
    void put(std::size_t version, std::span<const float> frame);
    /// Writes the tone-mapped image. \throws InputError as PendingOutput, DeviceError.
    void write(const std::filesystem::path& file, bool force) const;

  private:
    [[nodiscard]] std::span<float> canvas_row(int plane, int row, std::size_t version);

    FrameShape frame_;
    FrameShape canvas_;
    std::vector<float> light_;
};

}  // namespace stipple
