// A table of quality (PSNR in dB, linear / after 1/2.2) and of the rate of `fast`, for each clip of
// the footage folder: the figures of docs/decoder_experiments.md.
#include <fmt/format.h>

#include <chrono>

#include "tests/pipeline/clip.h"
#include "tests/support/footage_folder.h"

namespace stipple {
namespace {

std::string text(const VideoQuality& quality) {
    return fmt::format("{:.2f}/{:.2f}", quality.psnr_db, quality.psnr_gamma_db);
}

void print_row(const std::string& name, const FluxVideo& video) {
    const auto begin = std::chrono::steady_clock::now();
    const VideoQuality fast = quality_of(video, "random", DecodeMethod::kFast);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    fmt::print("| {} | {} | {} | {} | **{}** | {} | {:.2f} |\n", name,
               text(quality_of(video, "full4x", DecodeMethod::kNaive)),
               text(quality_of(video, "full1x", DecodeMethod::kNaive)),
               text(quality_of(video, "random", DecodeMethod::kNaive)), text(fast),
               text(quality_of(video, "tiled", DecodeMethod::kFast)),
               static_cast<double>(video.voxels()) / seconds.count() / 1e6);
}

void print_table() {
    fmt::print(
        "| clip | 4x exposure | 1x exposure | naive | fast | fast, tiled | Mvoxel/s |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const char* name : {"mouse250_a", "mouse250_b", "nat30_blocks", "nat30_coffee", "hdr_desk",
                             "hdr_desk_fg", "hdr_stilllife"}) {
        const auto video = luminance_clip(name);
        if (video)
            print_row(name, *video);
        else
            fmt::print("| {} | not in {} |\n", name, footage_folder().string());
    }
}

}  // namespace
}  // namespace stipple

int main() {
    stipple::print_table();
}
