#include "apps/report/preview_picture.h"

#include <fmt/format.h>

#include <cstddef>
#include <vector>

#include "apps/report/side_by_side.h"
#include "io/frame_writer.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

/// In colour, with the pixels that are too bright in red.
std::vector<float> marked(const PreviewFrame& frame) {
    const std::size_t pixels = frame.shape.pixels();
    std::vector<float> light(3 * pixels);
    for (std::size_t plane = 0; plane < 3; ++plane)
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const float own = frame.light[frame.shape.planes == 3 ? plane * pixels + pixel : pixel];
            const float red = plane == 0 ? kWhiteLight : 0;
            light[plane * pixels + pixel] = frame.too_bright[pixel] ? red : own;
        }
    return light;
}

void write_picture(const std::filesystem::path& file, const PreviewFrame& frame) {
    const auto text = fmt::format("slot {}: mean light {:.3f}, {:.2f} % too bright", frame.slot,
                                  frame.mean_light(), 100 * frame.too_bright_fraction());
    SideBySide picture({frame.shape.rows, frame.shape.cols, 3}, {text});
    picture.put(0, marked(frame));
    picture.write(file, true);
}

}  // namespace

void write_preview(const std::filesystem::path& file, const PreviewFrame& frame) {
    if (file.extension() == ".png") return write_picture(file, frame);
    FrameWriter writer(file, frame.shape, {.force = true});
    writer.write(frame.light);
    writer.finish();
}

}  // namespace stipple
