#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry.h"
#include "core/progress.h"
#include "decoder/decode_method.h"
#include "study/decoders/own_decoder.h"
#include "study/report/run_report.h"

namespace stipple {

/// Footage that the sensor of a report saw.
struct ReportTruth {
    std::string name;  ///< for messages
    FrameShape shape;
    std::uint64_t bytes = 0;                       ///< as input_bytes
    std::function<std::span<const float>()> next;  ///< a frame, order (plane, row, col), or none
};

using ReportMethod = std::variant<DecodeMethod, OwnDecoder>;

/// Streams, and what a page shows of them: what `stipple report` makes.
struct StreamReportTask {
    std::vector<std::string> runs;  ///< streams, or folders of them
    std::filesystem::path output;   ///< the page
    bool force = false;             ///< replace it
    std::optional<ReportTruth> truth = {};
    std::vector<ReportMethod> methods = {
        DecodeMethod::kFast};  ///< beside naive; the first is shown
    std::string camera = {};   ///< JSON text of RunReport::set_camera; empty: none
    /// The brightest light is that of the streams, and the margin the usual one.
    RunReportOptions page = {};
};

/// Who waits for a report.
struct ReportCalls {
    /// May throw to give up.
    std::function<void()> check;
    /// Begins a decoding of so many slots, as "clip.stipple, fast"; what it returns receives them.
    std::function<ProgressCallback(const std::string& task, std::int64_t slots)> begin;
};

/// A page that was written.
struct StreamReportResult {
    std::string figures;  ///< the keys of `report` in docs/outputs.md, JSON text
    std::uint64_t bytes = 0;
    std::size_t runs = 0;
    std::size_t videos = 0;
    std::vector<std::string> notes;
    std::string damage;  ///< of the streams; empty: none
};

/// Decodes the first slots of the streams and writes the page. \throws InputError, DeviceError;
/// DecoderFault and what else an OwnDecoder throws.
[[nodiscard]] StreamReportResult report_streams(StreamReportTask task, const ReportCalls& calls);

}  // namespace stipple
