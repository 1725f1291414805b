#include "apps/scene_arguments.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace stipple {
namespace {

constexpr int kLeastSide = 8;  // as SceneOptions
constexpr int kMostSide = 4096;
constexpr int kMostSlots = 1000000;

/// Takes "640x480". \throws CLI::ValidationError.
void parse_size(const std::string& text, FrameShape& shape) {
    const char* const end = text.data() + text.size();
    const auto cols = std::from_chars(text.data(), end, shape.cols);
    const bool crossed = cols.ptr != end && *cols.ptr == 'x';
    const auto rows = std::from_chars(crossed ? cols.ptr + 1 : end, end, shape.rows);
    if (cols.ec != std::errc() || rows.ec != std::errc() || rows.ptr != end)
        throw CLI::ValidationError("--size", "\"" + text + "\" is not a size like 640x480");
    for (const int side : {shape.cols, shape.rows})
        if (side < kLeastSide || side > kMostSide)
            throw CLI::ValidationError("--size", text + ": sides are 8 to 4096 pixels");
}

}  // namespace

void add_scene_arguments(CLI::App& command, SceneOptions& options) {
    command.add_option("--frames", options.slots, "frames of 1/200 s (48)")
        ->check(CLI::Range(1, kMostSlots))
        ->type_name("N");
    command
        .add_option_function<std::string>(
            "--size", [&options](const std::string& text) { parse_size(text, options.shape); },
            "width and height (320x240)")
        ->type_name("WxH");
    command.add_option("--seed", options.seed, "textures and arrangement (1)")
        ->check(CLI::NonNegativeNumber)
        ->type_name("S");
}

}  // namespace stipple
