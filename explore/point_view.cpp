#include "explore/point_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/error.h"
#include "core/parsed_number.h"
#include "io/footage_part.h"

namespace stipple {
namespace {

/// The value of an axis that the space may not have; empty: the default.
std::string value_of(const Space& space, const SpacePoint& point, std::string_view name) {
    const std::size_t place = space.axis(name);
    return place == space.axes.size() ? "" : point[place];
}

FluxVideo part_of(const FluxVideo& light, const FootagePart& part) {
    FrameReduction reduction(part, light.shape(), ColourFilter::kNone, "the clip");
    FluxVideo of_part(light.slots(), reduction.shape());
    for (int slot = 0; slot < light.slots(); ++slot)
        reduction(light.frame(slot), of_part.frame(slot));
    return of_part;
}

}  // namespace

FrameShape PointView::window(FrameShape array) const {
    return {std::max(1, static_cast<int>(rows * array.rows)), array.cols, array.planes};
}

FrameShape PointView::binned(FrameShape window) const {
    return {window.rows / binning, window.cols / binning, window.planes};
}

bool has_view(const Space& space, const SpacePoint& point) {
    return std::ranges::any_of(
        kViewAxes, [&](const char* name) { return !value_of(space, point, name).empty(); });
}

PointView view_of(const Space& space, const SpacePoint& point) {
    PointView view;
    if (const std::string text = value_of(space, point, "binning"); !text.empty()) {
        const auto n = parsed_number<int>(text);
        if (!n || *n < 1 || *n > kMaxBinning)
            throw InputError("binning", fmt::format("\"{}\" is not a whole number from 1 to {}",
                                                    text, kMaxBinning));
        view.binning = *n;
    }
    if (const std::string text = value_of(space, point, "binning_mode"); !text.empty())
        view.mode = value_in(kBinningModes, text, "binning_mode");
    if (const std::string text = value_of(space, point, "window_rows"); !text.empty()) {
        const auto rows = parsed_number<double>(text);
        if (!rows || !(*rows > 0 && *rows <= 1))
            throw InputError(
                "window_rows",
                fmt::format("\"{}\" is not a fraction of the rows, above 0 and up to 1", text));
        view.rows = *rows;
    }
    if (view.binning > 1 && !space.rig(point).empty())
        throw InputError("binning", "is of one sensor, but the point has a rig");
    return view;
}

FluxVideo window_light(const FluxVideo& light, const PointView& view) {
    const FrameShape window = view.window(light.shape());
    return part_of(light, {.crop = CropArea{window.rows, window.cols}});
}

FluxVideo binned_light(const FluxVideo& window, const PointView& view) {
    return part_of(window, {.bin = view.binning});
}

}  // namespace stipple
