#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/flux_video.h"
#include "core/geometry.h"
#include "stream/stream_header.h"
#include "study/metrics/video_quality.h"
#include "study/report/report_window.h"

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

/// A video of a report: its maker, and its run.
struct VideoTitle {
    std::string name;
    std::string text = {};                ///< description, a line
    std::optional<std::size_t> run = {};  ///< whose samples were decoded to it
};

/// A report: videos, their truth, the streams that were decoded to them, the figures of a camera.
/// The numbers are computed here and by the libraries; the page draws them.
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
    /// A further video, which the page shows first, unless `feature` follows; returns its number.
    std::size_t add_video(VideoTitle title);
    /// The video that the page shows first.
    void feature(std::size_t video);
    /// A frame of a video, order (plane, row, col), in the order of slots; those beyond the shown
    /// slots are left out.
    void put(std::size_t video, std::int64_t slot, std::span<const float> frame);
    /// The figures of a camera, as `stipple characterize --json` writes them. \throws InputError if
    /// the text is no JSON.
    void set_camera(const std::string& json);

    /// Leaves out pictures until the file is within its bound. \throws InputError if it cannot be.
    void fit();
    /// Damage of the streams, as far as they were read; empty if there is none.
    [[nodiscard]] std::string damage() const;
    /// What was left out, a sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const;
    /// The data of the page (docs/report.md), as JSON text.
    [[nodiscard]] std::string json() const;
    /// The page: the text of an HTML file that needs no other. Call it last: the pictures move into
    /// it.
    [[nodiscard]] std::string page();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// A page of the figures of a camera (RunReport::set_camera) alone.
[[nodiscard]] std::string camera_page(const std::string& title, const std::string& command,
                                      const std::string& json);

/// Warning that pages have no charts, with the remedy, if Chart.js was not found when the library
/// was built; else empty.
[[nodiscard]] std::string chart_warning();

/// The brightest light that an exposure of the stream can tell: that at which its shortest exposure
/// saturates, per slot.
[[nodiscard]] double brightest_light(const StreamHeader& header);

}  // namespace stipple
