#include "apps/demo_trials.h"

#include <fmt/format.h>

#include "apps/interrupt.h"
#include "apps/output/progress.h"
#include "apps/stream_output.h"
#include "readout/sensor_file.h"
#include "study/explore/trial.h"

namespace stipple {

FluxVideo render_video(const Scene& scene, const RunOptions& run) {
    const SceneOptions& options = scene.options();
    FluxVideo video(options.slots, options.shape);
    Progress progress(run, "rendering", options.slots);
    for (int slot = 0; slot < options.slots; ++slot) {
        throw_if_stopped();
        scene.render(slot, video.frame(slot));
        progress.advance();
    }
    return video;
}

StreamSize emulate_video(const FluxVideo& light, const std::string& schedule,
                         const std::filesystem::path& file, const RunOptions& run) {
    const SensorSetup setup = set_up_sensor({.schedule = schedule}, light.shape());
    StreamRecorder recorder = open_stream_output(file, run, setup, {.name = "embedded scene"});
    Progress progress(run, fmt::format("emulating ({})", schedule), light.slots());
    for (int slot = 0; slot < light.slots(); ++slot) {
        throw_if_stopped();
        recorder.expose(light.frame(slot));
        progress.advance();
    }
    recorder.finish();
    const double duration_us = light.slots() * setup.params.slot_us;
    const std::uint64_t bits = recorder.payload_bits();
    return {recorder.compression_ratio(), bits, static_cast<double>(bits) / duration_us};
}

VideoQuality decode_and_compare(const std::filesystem::path& file, DecodeMethod method,
                                const FluxVideo& truth, const FrameSink& take,
                                const RunOptions& run) {
    StreamReader reader(file);
    QualityMeter meter(truth.shape(), trial_quality(truth.slots()));
    Progress progress(run, fmt::format("decoding {}", file.filename().string()), truth.slots());
    decode(
        reader, method,
        [&](std::int64_t slot, std::span<const float> frame) {
            meter.add(frame, truth.frame(static_cast<int>(slot)));
            return take(slot, frame);
        },
        [&](double slots) {
            progress.reach(slots);
            return stop_signal() == 0;
        });
    throw_if_stopped();
    return meter.quality();
}

}  // namespace stipple
