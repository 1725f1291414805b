#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "core/flux_video.h"
#include "decoder/decode_method.h"
#include "decoder/progress_callback.h"
#include "decoder/stage_observer.h"
#include "stream/stream_reader.h"

namespace stipple {

struct DecodeOptions;
struct Measurements;

/// Takes the frames of a decoded video in slot order; order (plane, row, col), units of
/// FluxVideo. Returns false to stop decoding.
using FrameSink = std::function<bool(std::int64_t slot, std::span<const float> frame)>;

/// Told now and then, by the thread that called `decode`, how many slots' worth of work is done.
/// Returns false to stop without the block being worked on, which may hold a minute of work.
using DecodeMonitor = std::function<bool(double slots)>;

struct DecodeReport {
    std::int64_t slots = 0;               ///< frames delivered
    std::uint64_t voxels = 0;             ///< slots x planes x rows x cols
    std::uint64_t samples = 0;            ///< read for them
    std::uint64_t saturated_samples = 0;  ///< of these, only a lower bound
    double seconds = 0;                   ///< wall time, the sink's included
};

/// Decodes a stream from where its reader stands (its beginning), block by block: memory does not
/// grow with the length of the stream. The same bits for any thread count. Samples that are
/// missing or damaged count as unobserved; `reader.report()` says which.
/// A mosaic of colours is decoded to three planes as one problem, in which the colours that a
/// pixel does not see are unobserved: frames have the `decoded_shape` of the header.
/// \throws InputError as StreamReader::next, if the method cannot decode the schedule, or if slots
/// without samples are out of proportion to the others (max_missing_slots; more than 128 MB of
/// frames and 128 values for a sample, or of a file of less than 1 MB more than 256 MB), unless the
/// options have `fill_gaps`; as check_memory if a block takes too much.
DecodeReport decode(
    StreamReader& reader, const DecodeOptions& options, const FrameSink& sink,
    const DecodeMonitor& monitor = [](double) { return true; });

/// With the defaults of a method.
DecodeReport decode(
    StreamReader& reader, DecodeMethod method, const FrameSink& sink,
    const DecodeMonitor& monitor = [](double) { return true; });

/// Decodes one block as `decode` does; the result may be slightly negative. Nothing if `progress`
/// has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_block(
    Measurements measurements, const Calibration& calibration, const DecodeOptions& options,
    const ProgressCallback& progress = [](double) { return true; },
    const StageObserver& observer = {});

}  // namespace stipple
