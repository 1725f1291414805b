#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/decode_method.h"
#include "decoder/joint/joint_measurements.h"
#include "decoder/stage_observer.h"
#include "stream/stream_reader.h"

namespace stipple {

struct DecodeOptions;
struct Measurements;

/// Receives the frames of a decoded video in slot order; order (plane, row, col), units of
/// FluxVideo. Returns false to stop decoding.
using FrameSink = std::function<bool(std::int64_t slot, std::span<const float> frame)>;

struct DecodeReport {
    std::int64_t slots = 0;               ///< frames delivered
    std::uint64_t voxels = 0;             ///< slots x planes x rows x cols
    std::uint64_t samples = 0;            ///< read for these slots
    std::uint64_t saturated_samples = 0;  ///< of these, only a lower bound
    std::uint64_t zero_samples = 0;       ///< at DN 0, where noise is cut off
    double seconds = 0;                   ///< wall time, including the sink
};

/// Decodes a stream from the position of its reader (the beginning), block by block: memory does
/// not grow with the length of the stream. The same bits for any thread count. Missing and damaged
/// samples count as unobserved; `reader.report()` lists them. A mosaic of colours is decoded to
/// three planes as one problem, in which the colours that a pixel does not measure are unobserved:
/// frames have the `decoded_shape` of the header. `progress` receives slots; if it stops, the
/// present block, which may take a minute, is not delivered. \throws InputError as
/// StreamReader::next; if the method cannot decode the schedule; if too many slots are without
/// samples (max_missing_slots; more than 128 MB of frames and 128 values per sample, or of a file
/// of less than 1 MB more than 256 MB) and the options do not have `fill_gaps`; and as check_memory
/// if a block needs too much.
DecodeReport decode(
    StreamReader& reader, const DecodeOptions& options, const FrameSink& sink,
    const ProgressCallback& progress = [](double) { return true; });

/// Uses the defaults of a method.
DecodeReport decode(
    StreamReader& reader, DecodeMethod method, const FrameSink& sink,
    const ProgressCallback& progress = [](double) { return true; });

/// A sensor of a rig.
struct RigStream {
    StreamReader& reader;
    SensorView view = {};
};

/// Decodes the streams of several sensors that see one scene (docs/rig.md) to one video, on the
/// grid and in the slots of the first one, as `decode` does one stream; for one sensor it has the
/// same bits. What a sensor does not see is unobserved by it. Counts are those of all sensors.
/// \throws InputError as `decode`; if the streams differ in `slot_us` or in the shape of the
/// decoded frames, if the first sensor is moved, or another one sees none of its pixels or none of
/// its slots; if the method decodes one sensor only.
DecodeReport decode_rig(
    std::span<const RigStream> rig, const DecodeOptions& options, const FrameSink& sink,
    const ProgressCallback& progress = [](double) { return true; });

/// Decodes one block as `decode` does; the result may be slightly negative. Returns nothing if
/// `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_block(
    Measurements measurements, const Calibration& calibration, const DecodeOptions& options,
    const ProgressCallback& progress = [](double) { return true; },
    const StageObserver& observer = {});

}  // namespace stipple
