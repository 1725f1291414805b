#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/message.h"
#include "io/footage_reader.h"
#include "session/decode_setup.h"
#include "session/stream_calibration.h"
#include "view/camera_view.h"
#include "view/page_server.h"
#include "view/slot_decoder.h"
#include "view/stream_timeline.h"
#include "view/viewed_stream.h"
#include "view/viewed_video.h"

namespace stipple {

/// What a page shows.
struct ViewOptions {
    std::vector<std::filesystem::path> sources;  ///< sample streams, and footage or decoded videos
    CameraView* camera = nullptr;                ///< in place of sources
    std::filesystem::path truth = {};            ///< footage that the sensor saw; empty: none
    FootageOptions footage = {};
    DecodeSetup decoding = {};  ///< of the blocks
    CalibrationChoice calibration = {};
    std::string command = {};  ///< that shows the page
    std::function<void(const Message&)> warn = [](const Message&) {};
};

/// The page of `stipple view`, and all that it asks for. The pictures are made when they are looked
/// at, so that a long stream opens at once. For several threads.
class ViewPage {
  public:
    /// \throws InputError as ViewedStream and ViewedVideo, and if the frames of the sources differ
    /// in shape.
    explicit ViewPage(const ViewOptions& options);

    /// Answers what page/served.js asks for:
    /// - "": the page;
    /// - "status" ("than", "wait"): JSON, the `slots` so far, the `first` that is not forgotten,
    ///   `switched`, the slot of the last switch of each run, 0 without one, and whether the
    ///   streams are `complete`; waits `wait` ms for more slots than `than`;
    /// - "run" ("run"): JSON, ViewedStream::json;
    /// - "plane/v0-12", ("viewer", "than", "wait"): light_code of slot 12 of video 0, 16 bits each,
    ///   little-endian; of a decoded one better than level `than`, for which it waits `wait` ms, or
    ///   no bytes;
    /// - "plane/r0k-12", "plane/r0d-12", "plane/r0e-12": kinds, DN, and exposures under way in run
    /// 0;
    /// - "samples" ("run", "row", "col", "first", "end"): JSON, ViewedStream::samples_of_pixel;
    /// - "timeline" ("run"): JSON, StreamTimeline::json;
    /// - "readout" ("run", "slot"): JSON, readout_lanes_json;
    /// - "camera", "camera/features": JSON, CameraView::status and features; the acts
    ///   "camera/record", "camera/stop" and "camera/sensor" ("changes", of change_sensor);
    /// - "light" ("video", "row", "col", "plane", "first", "end"): JSON, [slot, code] where known.
    /// \throws InputError if a picture cannot be made.
    [[nodiscard]] std::optional<PageAnswer> answer(const PageRequest& request);

    /// Answers at once from now on, with what is there: before its server ends.
    void end();
    /// Of the longest source, so far.
    [[nodiscard]] std::int64_t slots();
    [[nodiscard]] FrameShape shape() const { return shape_; }

  private:
    struct Video {
        std::string name;
        std::string text;
        std::optional<std::size_t> run;  ///< decoded from it
        SlotDecoder* decoder = nullptr;
        /// Without a decoder: light_code of a slot, and of one of its pixels.
        std::function<std::vector<std::uint16_t>(std::int64_t slot)> codes = {};
        std::function<std::optional<std::uint16_t>(std::int64_t slot, int plane, int row, int col)>
            code = {};
    };
    void add_camera(CameraView& camera);
    void add_stream(const std::filesystem::path& file, const ViewOptions& options);
    void add_footage(const std::filesystem::path& source, const ViewOptions& options);
    void require_shape(FrameShape shape, const std::filesystem::path& source);
    [[nodiscard]] SlotExtent extent();
    [[nodiscard]] PageAnswer status(const PageRequest& request);
    [[nodiscard]] std::optional<PageAnswer> ask_camera(const std::string& what);
    [[nodiscard]] std::optional<PageAnswer> act(const PageRequest& request);
    [[nodiscard]] nlohmann::ordered_json data();
    [[nodiscard]] std::string html();
    [[nodiscard]] std::optional<PageAnswer> plane(const std::string& id,
                                                  const PageRequest& request);
    [[nodiscard]] std::optional<PageAnswer> picture(const Video& video, std::int64_t slot,
                                                    const PageRequest& request);
    void add_age(PageAnswer& answer, std::int64_t slot) const;
    [[nodiscard]] std::optional<PageAnswer> samples(const PageRequest& request);
    [[nodiscard]] std::optional<std::size_t> run_of(const PageRequest& request) const;
    [[nodiscard]] std::optional<PageAnswer> light(const PageRequest& request);

    std::string title_;
    std::string command_;
    CameraView* camera_;
    std::atomic<bool> ended_ = false;
    FrameShape shape_{};
    std::vector<std::string> notes_;
    std::deque<ViewedStream> streams_;
    std::deque<StreamTimeline> timelines_;  ///< of streams_, but a camera's
    std::deque<ViewedVideo> footage_;
    std::deque<SlotDecoder> decoders_;  ///< of streams_, which they use
    std::vector<Video> videos_;
    std::optional<std::size_t> truth_;
};

}  // namespace stipple
