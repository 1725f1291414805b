// A sensor with a colour filter array (RGGB) on the colour clips of the footage folder: PSNR in dB
// over the planes R, G, B, linear / after 1/2.2, of
// - stacked: three planes at each pixel, thrice the samples;
// - joint: the mosaic as one problem, as `decode` does it;
// - naive: nearest samples, colours interpolated;
// - alone: each colour of the mosaic decoded as a mono video of full size in which the pixels of
//   other colours have no exposures;
// - demosaiced: the four pixels of the cells decoded as four mono videos of half the size, put
//   together to mosaics, then OpenCV's edge-aware demosaicing of 16 bits a pixel: of linear light,
//   and of its square root.
// Arguments: [method [side [clip ...]]]; of each clip the middle of `side` pixels, 0 for all of it.
// The figures of docs/notes/decoder_experiments.md.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/pipeline/clip.h"
#include "tests/support/footage_folder.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr ColourFilter kFilter = ColourFilter::kRggb;

std::string text(const VideoQuality& quality) {
    return fmt::format("{:.2f}/{:.2f}", quality.psnr_db, quality.psnr_gamma_db);
}

FluxVideo joint(const FluxVideo& video, DecodeMethod method) {
    const TemporaryFolder folder;
    write_mosaic(video, kFilter, schedule_of("random", video.shape()), folder / "clip.stipple");
    return read_recording(folder / "clip.stipple", method);
}

FluxVideo one_plane(const FluxVideo& video, int plane) {
    const FrameShape shape = video.shape();
    FluxVideo one(video.slots(), {.rows = shape.rows, .cols = shape.cols, .planes = 1});
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::copy(video.frame(slot).subspan(
                              static_cast<std::size_t>(plane) * shape.pixels(), shape.pixels()),
                          one.frame(slot).begin());
    return one;
}

/// The schedule without the exposures of pixels of other colours than `plane`. Precondition: the
/// tile has even sides.
NamedSchedule schedule_of_plane(NamedSchedule named, int plane) {
    const ExposureSchedule& whole = named.schedule;
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (int row = 0; row < whole.tile_rows(); ++row)
        for (int col = 0; col < whole.tile_cols(); ++col) {
            if (colour_plane(kFilter, row, col) == plane)
                exposures.insert(exposures.end(), whole.exposures(row, col).begin(),
                                 whole.exposures(row, col).end());
            first.push_back(static_cast<std::uint32_t>(exposures.size()));
        }
    named.schedule = {whole.tile_rows(), whole.tile_cols(), whole.period_slots(), std::move(first),
                      std::move(exposures)};
    named.source = {};
    return named;
}

FluxVideo alone(const FluxVideo& video, DecodeMethod method) {
    const TemporaryFolder folder;
    const NamedSchedule schedule = schedule_of("random", video.shape());
    FluxVideo result(video.slots(), video.shape());
    for (int plane = 0; plane < 3; ++plane) {
        const auto file = folder / fmt::format("{}.stipple", plane);
        write_recording(one_plane(video, plane), schedule_of_plane(schedule, plane), 1, file);
        const FluxVideo decoded = read_recording(file, method);
        const auto begin = static_cast<std::size_t>(plane) * video.shape().pixels();
        for (int slot = 0; slot < video.slots(); ++slot)
            std::ranges::copy(decoded.frame(slot),
                              result.frame(slot).subspan(begin, decoded.shape().pixels()).begin());
    }
    return result;
}

/// Copies between one pixel (row, col) of each cell of a mosaic and a video of half the size.
template <typename Copy>
void visit_cells(const FluxVideo& half, int row, int col, const Copy& copy) {
    for (int slot = 0; slot < half.slots(); ++slot)
        for (int r = 0; r < half.shape().rows; ++r)
            for (int c = 0; c < half.shape().cols; ++c) copy(slot, r, c, 2 * r + row, 2 * c + col);
}

/// The mosaic, as one plane, from its four pixels decoded apart. Precondition: even sides.
FluxVideo mosaic_of_quarters(const FluxVideo& video, DecodeMethod method) {
    const TemporaryFolder folder;
    const FrameShape shape = video.shape();
    FluxVideo mosaic(video.slots(), {.rows = shape.rows, .cols = shape.cols, .planes = 1});
    for (int i = 0; i < 4; ++i) {
        const int row = i / 2;
        const int col = i % 2;
        const int plane = colour_plane(kFilter, row, col);
        FluxVideo half(video.slots(), {.rows = shape.rows / 2, .cols = shape.cols / 2});
        visit_cells(half, row, col, [&](int slot, int r, int c, int from_row, int from_col) {
            half.plane(slot, 0)(r, c) = video.plane(slot, plane)(from_row, from_col);
        });
        const auto file = folder / fmt::format("{}.stipple", i);
        write_recording(half, schedule_of("random", half.shape()),
                        static_cast<std::uint64_t>(i) + 1, file);
        const FluxVideo decoded = read_recording(file, method);
        visit_cells(half, row, col, [&](int slot, int r, int c, int to_row, int to_col) {
            mosaic.plane(slot, 0)(to_row, to_col) = decoded.plane(slot, 0)(r, c);
        });
    }
    return mosaic;
}

/// Light to 16 bits and back: as it is, or its square root.
struct Encoding {
    bool root;
    [[nodiscard]] std::uint16_t to_bits(float light) const {
        const float value = std::min(light / 4, 1.0F);
        return static_cast<std::uint16_t>(65535 * (root ? std::sqrt(value) : value) + 0.5F);
    }
    [[nodiscard]] float to_light(std::uint16_t bits) const {
        const float value = static_cast<float>(bits) / 65535;
        return 4 * (root ? value * value : value);
    }
};

FluxVideo demosaic(const FluxVideo& mosaic, const Encoding& encoding) {
    FrameShape shape = mosaic.shape();
    shape.planes = 3;
    FluxVideo video(mosaic.slots(), shape);
    for (int slot = 0; slot < mosaic.slots(); ++slot) {
        cv::Mat bits(shape.rows, shape.cols, CV_16U);
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                bits.at<std::uint16_t>(row, col) =
                    encoding.to_bits(mosaic.plane(slot, 0)(row, col));
        cv::Mat rgb;
        cv::cvtColor(bits, rgb, cv::COLOR_BayerRGGB2RGB_EA);
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < shape.rows; ++row)
                for (int col = 0; col < shape.cols; ++col)
                    video.plane(slot, plane)(row, col) =
                        encoding.to_light(rgb.at<cv::Vec<std::uint16_t, 3>>(row, col)[plane]);
    }
    return video;
}

/// The middle of the frames, from even rows and columns. Precondition: an even side.
FluxVideo middle_of(const FluxVideo& video, int side) {
    const FrameShape shape = video.shape();
    if (side == 0 || side >= std::min(shape.rows, shape.cols)) return video;
    FluxVideo middle(video.slots(), {.rows = side, .cols = side, .planes = shape.planes});
    const int top = (shape.rows - side) / 4 * 2;
    const auto left = static_cast<std::size_t>((shape.cols - side) / 4 * 2);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (int plane = 0; plane < shape.planes; ++plane)
            for (int row = 0; row < side; ++row)
                std::ranges::copy(video.plane(slot, plane)
                                      .row(top + row)
                                      .subspan(left, static_cast<std::size_t>(side)),
                                  middle.plane(slot, plane).row(row).begin());
    return middle;
}

void print_row(const std::string& name, const FluxVideo& video, DecodeMethod method) {
    const FluxVideo mosaic = mosaic_of_quarters(video, method);
    fmt::print("| {} | {} | **{}** | {} | {} | {} | {} |\n", name,
               text(quality_of(video, "random", method)),
               text(quality_of(joint(video, method), video)),
               text(quality_of(joint(video, DecodeMethod::kNaive), video)),
               text(quality_of(alone(video, method), video)),
               text(quality_of(demosaic(mosaic, {.root = false}), video)),
               text(quality_of(demosaic(mosaic, {.root = true}), video)));
    std::fflush(stdout);  // rows take minutes
}

void print_table(DecodeMethod method, int side, std::vector<std::string> clips) {
    if (clips.empty())
        clips = {"nat30_blocks", "nat30_coffee", "hdr_desk", "hdr_desk_fg", "hdr_stilllife"};
    fmt::print(
        "| clip | stacked | joint | naive | alone | demosaiced | demosaiced roots |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const std::string& name : clips) {
        const auto video = colour_clip(name);
        if (video)
            print_row(name, middle_of(*video, side), method);
        else
            fmt::print("| {} | no clip in colour in {} |\n", name, footage_folder().string());
    }
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    std::vector<std::string> arguments(argv + 1, argv + argc);
    if (arguments.empty()) arguments.emplace_back("fast");
    if (arguments.size() == 1) arguments.emplace_back("0");
    int side = 0;
    const char* end = arguments[1].data() + arguments[1].size();
    const auto [rest, problem] = std::from_chars(arguments[1].data(), end, side);
    if (rest != end || problem != std::errc() || side < 0 || side % 2 != 0) {
        fmt::print(stderr, "side: {} is not an even number of pixels\n", arguments[1]);
        return 1;
    }
    try {
        stipple::print_table(stipple::decode_method_from_name(arguments[0]), side,
                             {arguments.begin() + 2, arguments.end()});
    } catch (const stipple::InputError& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
