#include <cstdint>
#include <string>

#include "core/error.h"
#include "study/explore/results.h"
#include "study/explore/space.h"
#include "tests/fuzz/require.h"

namespace stipple {
namespace {

/// A point as a space of its own has the same values.
void check_point(const Space& space, std::uint64_t number) {
    const SpacePoint point = space.point(number);
    const PointClip clip{.slots = space.frames, .compared = {}, .is_whole = true};
    const Space one = parse_space(point_space(space, point, clip), "point.toml");
    require(one.size() == 1);
    for (const SpaceAxis& axis : space.axes)
        require(one.value(one.point(0), axis.name) == space.value(point, axis.name));
    static_cast<void>(point_commands(space, point, clip));
}

}  // namespace
}  // namespace stipple

/// Input: a space.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const stipple::Space space =
            stipple::parse_space(std::string(data, data + size), "space.toml");
        stipple::check_point(space, 0);
        stipple::check_point(space, space.size() - 1);
    } catch (const stipple::InputError&) {
    }
    return 0;
}
