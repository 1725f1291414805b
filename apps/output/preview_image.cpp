#include "apps/output/preview_image.h"

#include <fmt/format.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/output/side_by_side.h"
#include "io/frame_writer.h"
#include "io/tone_map.h"

namespace stipple {
namespace {

/// In colour, with saturated pixels in red.
std::vector<float> marked(const PreviewFrame& frame) {
    const std::size_t pixels = frame.shape.pixels();
    std::vector<float> light(3 * pixels);
    for (std::size_t plane = 0; plane < 3; ++plane)
        for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
            const float own = frame.light[frame.shape.planes == 3 ? plane * pixels + pixel : pixel];
            const float red = plane == 0 ? kWhiteLight : 0;
            light[plane * pixels + pixel] = frame.saturated[pixel] ? red : own;
        }
    return light;
}

void write_image(const std::filesystem::path& file, const PreviewFrame& frame) {
    const auto text = fmt::format("slot {}: mean light {:.3f}, {:.2f} % saturated", frame.slot,
                                  frame.mean_light(), 100 * frame.saturated_fraction());
    SideBySide image({frame.shape.rows, frame.shape.cols, 3}, {text});
    image.put(0, marked(frame));
    image.write(file, true);
}

}  // namespace

void write_preview(const std::filesystem::path& file, const PreviewFrame& frame) {
    if (file.extension() == ".png") return write_image(file, frame);
    FrameWriter writer(file, frame.shape, {.force = true});
    writer.write(frame.light);
    writer.finish();
}

nlohmann::ordered_json preview_json(const std::string& file, const LivePreview& preview) {
    const FrameShape shape = preview.decoder().shape();
    const PreviewCounts counts = preview.counts();
    nlohmann::ordered_json json{{"file", file},
                                {"width", shape.cols},
                                {"height", shape.rows},
                                {"slots", preview.decoder().slots()},
                                {"made", counts.made},
                                {"failed", counts.failed},
                                {"skipped_slots", counts.skipped_slots},
                                {"last_slot", nullptr},
                                {"delay_ms", nullptr}};
    if (counts.made == 0) return json;
    json["last_slot"] = counts.last_slot;
    json["delay_ms"] = {{"median", counts.delays.quantile_us(0.5) * 1e-3},
                        {"max", counts.delays.longest_us() * 1e-3}};
    return json;
}

std::string preview_text(const std::string& file, const LivePreview& preview) {
    const FrameShape shape = preview.decoder().shape();
    const PreviewCounts counts = preview.counts();
    std::string text =
        fmt::format("preview {}: {} x {} from {} slots; made {}, failed {}", file, shape.cols,
                    shape.rows, preview.decoder().slots(), counts.made, counts.failed);
    if (counts.made > 0)
        text +=
            fmt::format("; {:.1f} s behind its slot, at most {:.1f} s",
                        counts.delays.quantile_us(0.5) * 1e-6, counts.delays.longest_us() * 1e-6);
    return text;
}

}  // namespace stipple
