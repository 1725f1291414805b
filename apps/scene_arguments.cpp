#include "apps/scene_arguments.h"

#include <string>

#include "apps/number_check.h"
#include "apps/size_argument.h"

namespace stipple {
namespace {

constexpr int kMinSide = 8;  // as SceneOptions
constexpr int kMaxSide = 4096;
constexpr int kMaxSlots = 1000000;

}  // namespace

void add_scene_arguments(Command& command, SceneOptions& options) {
    command.add_option("--frames", options.slots, "frames of 1/200 s (48)")
        .check(whole_check(1, kMaxSlots))
        .type_name("N");
    command
        .add_parsed(
            "--size",
            [&options](const std::string& text) {
                parse_size("--size", text, kMinSide, kMaxSide, options.shape);
            },
            "width and height (320x240)")
        .type_name("WxH");
    command.add_option("--seed", options.seed, "textures and arrangement (1)")
        .check(whole_check(0))
        .type_name("S");
}

}  // namespace stipple
