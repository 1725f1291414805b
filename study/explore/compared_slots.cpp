#include "study/explore/trial.h"

#include <algorithm>
#include <set>
#include <vector>

#include "core/error.h"
#include "readout/sensor_file.h"
#include "study/explore/point_view.h"
#include "study/metrics/video_quality.h"

namespace stipple {
namespace {

ComparedSlots common(ComparedSlots a, ComparedSlots b) {
    return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// The values that decide when the pixels of a point expose.
std::string exposing_values(const Space& space, const SpacePoint& point) {
    std::string values;
    for (std::size_t i = 0; i < point.size(); ++i) {
        const std::string& name = space.axes[i].name;
        if (name != "footage" && name != "method" && name != "system" &&
            !name.starts_with("decoder."))
            values += name + "=" + point[i] + "\n";
    }
    return values;
}

ComparedSlots whole_slots_of(const Space& space, const SpacePoint& point, FrameShape light,
                             int slots) {
    ComparedSlots whole{0, slots};
    const PointView view = view_of(space, point);
    const Rig rig = rig_of(space, point).rig;
    const auto setups = set_up_rig(rig, view.binned(view.window(light)));
    for (std::size_t i = 0; i < setups.size(); ++i)
        whole = common(whole,
                       whole_slots(setups[i].schedule.schedule, rig.sensors[i].phase_slots, slots));
    return whole;
}

/// The space with all its systems.
Space with_all_systems(Space space) {
    if (space.systems.empty()) return space;
    std::vector<std::string>& names = space.axes[space.axis("system")].values;
    names.clear();
    for (const SpaceSystem& system : space.systems) names.push_back(system.name);
    return space;
}

}  // namespace

ComparedSlots whole_slots(const ExposureSchedule& schedule, std::int64_t phase_slots, int slots) {
    const std::int64_t period = schedule.period_slots();
    std::int64_t begin = phase_slots, end = slots;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col)) {
                const std::int64_t first = phase_slots + exposure.first_slot;
                const int span = exposure.span_slots();  // no longer than the period
                begin = std::max(begin, first - period + span);
                if (first >= slots) continue;
                const std::int64_t last = first + (slots - 1 - first) / period * period;
                if (last + span > slots) end = std::min(end, last);
            }
    return {static_cast<int>(std::min<std::int64_t>(begin, slots)),
            static_cast<int>(std::max<std::int64_t>(end, 0))};
}

ComparedSlots compared_slots(const Space& space, const TrialLight& light, int slots,
                             const KeepGoing& keep_going) {
    slots = std::min(slots, light.video.slots());
    const int margin = usual_margin(slots);
    const ComparedSlots inner{margin, slots - margin};
    if (space.compared.begin < std::min(space.compared.end, slots))
        return common(space.compared, {0, slots});
    const Space all = with_all_systems(space);
    ComparedSlots range = inner;
    std::set<std::string> seen;
    for (std::uint64_t number = 0; number < all.size(); ++number) {
        const SpacePoint point = all.point(number);
        if (!seen.insert(exposing_values(all, point)).second) continue;
        if (!keep_going()) throw TrialStopped();
        try {
            range = common(range, whole_slots_of(all, point, light.video.shape(), slots));
        } catch (const InputError&) {  // which its row of the table tells
        }
    }
    return 4 * (range.end - range.begin) < slots ? inner : range;
}

}  // namespace stipple
