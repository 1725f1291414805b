#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/flux_video.h"
#include "study/metrics/video_quality.h"
#include "study/report/report_page.h"
#include "study/report/report_window.h"
#include "study/report/run_report.h"

namespace stipple {

/// The videos of a report: their pictures in the shown area, each slot packed apart so that the
/// page unpacks what it shows, and their quality frame by frame.
class ReportVideos {
  public:
    /// With a `truth`, which must outlive this, all others are compared with it.
    ReportVideos(FrameShape shape, const PixelArea& area, const QualityOptions& quality,
                 const FluxVideo* truth);

    /// A further video; returns its number.
    std::size_t add(VideoTitle title);
    /// Its frame of `slot`, order (plane, row, col). Frames come in the order of slots. Its picture
    /// is kept if the slot is a multiple of `step`.
    void put(std::size_t video, std::int64_t slot, std::span<const float> frame);

    /// Bytes of the pictures in the page; one that equals that before it has its element only.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] std::int64_t step() const { return step_; }
    /// Leaves out the pictures of every second slot of those that are kept, now and later. Quality
    /// is of all frames.
    void halve();

    /// For each video `name`, `text`, `run`, and with a truth `quality` with the keys of `compare`
    /// and their values by frame under `frames`.
    [[nodiscard]] nlohmann::ordered_json json() const;
    /// "v0-12" is slot 12 of video 0; light codes, order (plane, row, col). A picture that equals
    /// that before it is "=" and the id of that one.
    [[nodiscard]] std::vector<PackedPlane> take_planes();

  private:
    struct Video {
        VideoTitle title;
        QualityMeter meter;
        std::vector<VideoQuality> frames;
        std::vector<std::int64_t> slots;
        std::vector<std::string> pictures;  ///< of `slots`
    };
    [[nodiscard]] static std::size_t bytes_of_last(const Video& video, std::size_t pictures);
    [[nodiscard]] nlohmann::ordered_json quality_of(const Video& video) const;

    FrameShape shape_;
    PixelArea area_;
    QualityOptions options_;
    const FluxVideo* truth_;
    std::vector<Video> videos_;
    std::int64_t step_ = 1;
    std::size_t bytes_ = 0;
};

}  // namespace stipple
