// What a conventional camera of the same bandwidth can do, against coded exposure, clip by clip:
// PSNR linear and after 1/2.2. The camera exposes every fourth slot (full1x); its frames are held
// and interpolated in time (naive), denoised by non-local means on the square root of light and
// interpolated along dense inverse search flow, both by OpenCV (chain), or decoded by our methods.
//
//     bench_conventional [SIDE] [SLOTS] [CLIP...]      middle of the frames (128), first slots (32)
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/photo.hpp>
#include <opencv2/video/tracking.hpp>
#include <string>
#include <vector>

#include "tests/pipeline/clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr double kBrightest = 2;   ///< light of the level 255
constexpr float kNlmStrength = 9;  ///< of levels; with 5 the result is up to 0.7 dB worse or better
constexpr int kPeriod = 4;

cv::Mat denoised(const FluxVideo& video, int slot) {
    const auto light = video.plane(slot, 0);
    cv::Mat levels(light.rows(), light.cols(), CV_8U);
    for (int row = 0; row < levels.rows; ++row)
        for (int col = 0; col < levels.cols; ++col)
            levels.at<uchar>(row, col) = cv::saturate_cast<uchar>(
                255 * std::sqrt(static_cast<double>(light(row, col)) / kBrightest));
    cv::Mat result;
    cv::fastNlMeansDenoising(levels, result, kNlmStrength);
    return result;
}

cv::Mat flow_of(const cv::Mat& from, const cv::Mat& to) {
    cv::Mat flow;
    cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_MEDIUM)->calc(from, to, flow);
    return flow;
}

cv::Mat warped(const cv::Mat& image, const cv::Mat& flow) {
    cv::Mat map(flow.size(), CV_32FC2);
    for (int row = 0; row < map.rows; ++row)
        for (int col = 0; col < map.cols; ++col)
            map.at<cv::Vec2f>(row, col) =
                cv::Vec2f(static_cast<float>(col), static_cast<float>(row)) +
                flow.at<cv::Vec2f>(row, col);
    cv::Mat result;
    cv::remap(image, result, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return result;
}

void put(const cv::Mat& levels, int slot, FluxVideo& video) {
    auto light = video.plane(slot, 0);
    for (int row = 0; row < levels.rows; ++row)
        for (int col = 0; col < levels.cols; ++col) {
            const float root = levels.at<float>(row, col) / 255;
            light(row, col) = root * root * static_cast<float>(kBrightest);
        }
}

/// `naive` holds the frames that the camera has taken, in the slots `first`, `first` + 4, ...
FluxVideo chain(const FluxVideo& naive, int first) {
    FluxVideo video(naive.slots(), naive.shape());
    std::vector<cv::Mat> frames;
    for (int slot = first; slot < naive.slots(); slot += kPeriod)
        frames.push_back(denoised(naive, slot));
    std::vector<cv::Mat> lights(frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) frames[i].convertTo(lights[i], CV_32F);
    for (int slot = 0; slot < video.slots(); ++slot) {
        const int at = std::clamp(slot - first, 0, kPeriod * (static_cast<int>(frames.size()) - 1));
        const auto i = static_cast<std::size_t>(at / kPeriod);
        const double a = static_cast<double>(at % kPeriod) / kPeriod;
        if (a == 0) {
            put(lights[i], slot, video);
            continue;
        }
        const cv::Mat forth = flow_of(frames[i], frames[i + 1]);
        const cv::Mat back = flow_of(frames[i + 1], frames[i]);
        const cv::Mat to_first = -(1 - a) * a * forth + a * a * back;
        const cv::Mat to_second = (1 - a) * (1 - a) * forth - a * (1 - a) * back;
        put((1 - a) * warped(lights[i], to_first) + a * warped(lights[i + 1], to_second), slot,
            video);
    }
    return video;
}

void print(const std::string& clip, const char* row, const VideoQuality& quality) {
    fmt::print("{:<16}{:<16}{:>8.2f}{:>8.2f}\n", clip, row, quality.psnr_db, quality.psnr_gamma_db);
    std::fflush(stdout);
}

void compare(const std::string& name, int side, int slots) {
    const auto clip = luminance_clip(name);
    if (!clip) {
        fmt::print("{}: no such footage\n", name);
        return;
    }
    const FluxVideo truth = middle(*clip, side, slots);
    const TemporaryFolder folder;
    const auto file = [&](const char* schedule) {
        return folder / (std::string(schedule) + ".stipple");
    };
    for (const char* schedule : {"full4x", "full1x", "random"})
        write_recording(truth, schedule, file(schedule));
    const auto decoded = [&](const char* schedule, DecodeMethod method) {
        return quality_of(read_recording(file(schedule), method), truth);
    };
    print(name, "4x naive", decoded("full4x", DecodeMethod::kNaive));
    print(name, "4x best", decoded("full4x", DecodeMethod::kBest));
    const FluxVideo naive = read_recording(file("full1x"), DecodeMethod::kNaive);
    print(name, "1x naive", quality_of(naive, truth));
    const auto first =
        schedule_of("full1x", truth.shape()).schedule.exposures(0, 0).front().first_slot;
    print(name, "1x chain", quality_of(chain(naive, static_cast<int>(first)), truth));
    print(name, "1x fast", decoded("full1x", DecodeMethod::kFast));
    print(name, "1x best", decoded("full1x", DecodeMethod::kBest));
    print(name, "coded fast", decoded("random", DecodeMethod::kFast));
    print(name, "coded best", decoded("random", DecodeMethod::kBest));
}

}  // namespace
}  // namespace stipple

int main(int argc, char** argv) {
    const int side = argc > 1 ? std::stoi(argv[1]) : 128;
    const int slots = argc > 2 ? std::stoi(argv[2]) : 32;
    std::vector<std::string> clips(argv + std::min(argc, 3), argv + argc);
    if (clips.empty())
        clips = {"mouse250_a", "mouse250_b",  "nat30_blocks", "nat30_coffee",
                 "hdr_desk",   "hdr_desk_fg", "hdr_stilllife"};
    for (const std::string& clip : clips) stipple::compare(clip, side, slots);
    return 0;
}
