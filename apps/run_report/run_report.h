#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/run_report/packed_plane.h"
#include "apps/run_report/report_videos.h"
#include "apps/run_report/report_window.h"
#include "core/flux_video.h"
#include "core/geometry.h"
#include "metrics/video_quality.h"
#include "stream/stream_header.h"

namespace stipple {

/// Default bound of a report's file.
inline constexpr std::uint64_t kReportBytes = std::uint64_t{96} << 20U;

struct RunReportOptions {
    std::string title = "Stipple report";
    std::string command = {};            ///< that made the report
    std::int64_t slots = 64;             ///< the first ones are shown
    std::optional<PixelArea> area = {};  ///< none: report_area
    QualityOptions quality = {};
    std::uint64_t max_bytes = kReportBytes;
};

/// What a report shows: videos, their truth, the streams that they were made of, the figures of a
/// camera. The numbers are those of the libraries; the page draws them.
class RunReport {
  public:
    /// For frames of `shape`. `truth`, or null, must outlive this; it becomes the first video.
    /// \throws InputError if the area does not lie in the frame.
    RunReport(RunReportOptions options, FrameShape shape, const FluxVideo* truth);
    ~RunReport();
    RunReport(const RunReport&) = delete;
    RunReport& operator=(const RunReport&) = delete;

    /// Reads the first slots of a stream: its header, samples, loads and schedule. Returns the
    /// number of the run. \throws InputError as StreamReader, and if its frames have another shape.
    std::size_t add_run(const std::filesystem::path& stream, const std::string& name);
    std::size_t add_video(VideoTitle title) { return featured_ = videos_.add(std::move(title)); }
    /// The video that the page shows first; by default the last one.
    void feature(std::size_t video) { featured_ = video; }
    /// A frame of a video; those beyond the shown slots are left out.
    void put(std::size_t video, std::int64_t slot, std::span<const float> frame);
    /// The figures of `stipple characterize` (camera_json).
    void set_camera(const nlohmann::ordered_json& camera);

    /// Leaves out pictures until the file is within its bound. \throws InputError if it cannot be.
    void fit();
    /// Damage of the streams, as far as they were read; empty if there is none.
    [[nodiscard]] std::string damage() const;
    /// What was left out, a sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    /// The data of the page (docs/report.md).
    [[nodiscard]] nlohmann::ordered_json json() const;
    /// The page. Call it last: the pictures move into it.
    [[nodiscard]] std::string page();

  private:
    struct Run;

    RunReportOptions options_;
    FrameShape shape_;
    PixelArea area_;
    std::int64_t truth_slots_;  ///< 0: there is no truth
    std::size_t featured_ = 0;
    ReportVideos videos_;
    std::vector<std::unique_ptr<Run>> runs_;
    std::unique_ptr<nlohmann::ordered_json> camera_;
    std::int64_t slots_ = 0;  ///< of the longest video or stream
    std::vector<std::string> notes_;
};

/// The data of a page without videos; further keys may be set: `videos`, `runs`, `camera`, `notes`.
[[nodiscard]] nlohmann::ordered_json empty_report_json(const std::string& title,
                                                       const std::string& command);

/// The brightest light that an exposure of the stream can tell: that at which its shortest exposure
/// saturates, per slot.
[[nodiscard]] double brightest_light(const StreamHeader& header);

}  // namespace stipple
