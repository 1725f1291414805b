#include "study/report/report_videos.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "study/report/json_figures.h"
#include "study/report/quality_metrics.h"
#include "study/report/report_page.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

}  // namespace

ReportVideos::ReportVideos(FrameShape shape, const PixelArea& area, const QualityOptions& quality,
                           const FluxVideo* truth)
    : shape_(shape), area_(area), options_(quality), truth_(truth) {}

std::size_t ReportVideos::add(VideoTitle title) {
    videos_.push_back({std::move(title), QualityMeter(shape_, options_), {}, {}, {}});
    return videos_.size() - 1;
}

void ReportVideos::put(std::size_t video, std::int64_t slot, std::span<const float> frame) {
    Video& to = videos_[video];
    if (slot % step_ == 0) {
        to.slots.push_back(slot);
        to.pictures.push_back(packed_plane(light_codes(cropped(frame, shape_, area_))));
        bytes_ += bytes_of_last(to, to.pictures.size());
    }
    if (truth_ == nullptr || slot >= truth_->slots()) return;
    const auto reference = truth_->frame(static_cast<int>(slot));
    if (reference.data() == frame.data()) return;  // the truth itself
    to.meter.add(frame, reference);
    to.frames.push_back(to.meter.last_quality());
}

/// Of the last one of the first `pictures`.
std::size_t ReportVideos::bytes_of_last(const Video& video, std::size_t pictures) {
    const std::string& last = video.pictures[pictures - 1];
    return pictures > 1 && video.pictures[pictures - 2] == last ? kPlaneTagBytes
                                                                : last.size() + kPlaneTagBytes;
}

void ReportVideos::halve() {
    step_ *= 2;
    bytes_ = 0;
    for (Video& video : videos_) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < video.slots.size(); ++i) {
            if (video.slots[i] % step_ != 0) continue;
            video.slots[kept] = video.slots[i];
            std::swap(video.pictures[kept++], video.pictures[i]);
            bytes_ += bytes_of_last(video, kept);
        }
        video.slots.resize(kept);
        video.pictures.resize(kept);
    }
}

ordered_json ReportVideos::quality_of(const Video& video) const {
    if (video.frames.size() <= 2 * static_cast<std::size_t>(options_.margin)) return nullptr;
    ordered_json psnr = ordered_json::array(), pu21 = psnr, ssim = psnr;
    for (const VideoQuality& frame : video.frames) {
        psnr.push_back(frame.psnr_db);
        pu21.push_back(frame.pu21_psnr_db);
        ssim.push_back(frame.ssim);
    }
    ordered_json json = quality_json(video.meter.quality());
    json["frames"] = {{"psnr_db", psnr}, {"pu21_psnr_db", pu21}, {"ssim", ssim}};
    return json;
}

ordered_json ReportVideos::json() const {
    ordered_json list = ordered_json::array();
    for (const Video& video : videos_) {
        ordered_json entry{{"name", video.title.name}, {"text", video.title.text}};
        entry["run"] = or_null(video.title.run);
        entry["quality"] = quality_of(video);
        list.push_back(entry);
    }
    return list;
}

std::vector<PackedPlane> ReportVideos::take_planes() {
    std::vector<PackedPlane> planes;
    for (std::size_t v = 0; v < videos_.size(); ++v) {
        std::size_t same = 0;  // the plane that the present picture may equal
        for (std::size_t i = 0; i < videos_[v].slots.size(); ++i) {
            std::string& picture = videos_[v].pictures[i];
            const bool is_same = i > 0 && planes[same].text == picture;
            if (!is_same) same = planes.size();
            planes.push_back({fmt::format("v{}-{}", v, videos_[v].slots[i]),
                              is_same ? "=" + planes[same].id : std::move(picture)});
        }
    }
    return planes;
}

}  // namespace stipple
