#include "tests/bench/sci/sci_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/philox.h"
#include "decoder/reconstruct.h"
#include "io/footage_reader.h"
#include "readout/emulator.h"
#include "readout/schedules/volume_schedule.h"
#include "sensor_model/sensor_config.h"
#include "stream/stream_reader.h"
#include "stream/stream_writer.h"
#include "study/metrics/video_quality.h"
#include "study/scenes/scene.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

SensorParams ideal_sensor(const SciSensor& sensor) {
    // All frames of a measurement at light 1.0 are just below full scale.
    const double full_scale_e = 1.001 * kSciFrames * sensor.electrons_per_unit;
    Config config(find_config(ConfigKind::kSensors, "ideal"),
                  {fmt::format("photons_per_unit={:.17g}", sensor.electrons_per_unit),
                   fmt::format("full_scale_e={:.17g}", full_scale_e),
                   fmt::format("full_well_e={:.17g}", full_scale_e)});
    return read_sensor(config);
}

void write_stream(const FluxVideo& video, const ExposureSchedule& schedule, const SciSensor& sensor,
                  const std::filesystem::path& file) {
    const SensorParams params = ideal_sensor(sensor);
    const SensorSetup setup{
        .params = params,
        .schedule = NamedSchedule{.name = "masks", .source = {}, .schedule = schedule},
        .shape = video.shape(),
        .footage = video.shape()};
    StreamHeader header = stream_header_of(setup, "");
    header.calibration.noise_free = sensor.noise_free;
    StreamWriter writer(file, header);
    Emulator emulator(setup);
    for (int slot = 0; slot < video.slots(); ++slot)
        for (const SamplePacket& packet : emulator.expose(video.frame(slot))) writer.write(packet);
    writer.finish();
}

/// Masks of `value(word)` for random words of 32 bits.
template <typename Value>
NpyVolume drawn_masks(FrameShape shape, std::uint64_t seed, const Value& value) {
    NpyVolume masks{kSciFrames, shape.rows, shape.cols, {}};
    const auto pixels = static_cast<std::uint32_t>(shape.pixels());
    for (std::uint32_t frame = 0; frame < kSciFrames; ++frame)
        for (std::uint32_t pixel = 0; pixel < pixels; ++pixel)
            masks.values.push_back(
                static_cast<double>(value(philox4x32({pixel, frame, 0, 0}, seed)[0])));
    return masks;
}

}  // namespace

FluxVideo read_sci_clip(const std::filesystem::path& folder, const std::string& name) {
    auto source = folder / (name + ".npy");
    if (!std::filesystem::exists(source)) source = folder / name;
    FootageReader reader(source, {.luminance = true, .max_value = 1});
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    while (reader.read(frame)) frames.push_back(frame);
    frames.resize(frames.size() / kSciFrames * kSciFrames);
    if (frames.empty())
        throw InputError(source.string(), fmt::format("has fewer than {} frames", kSciFrames));
    FluxVideo video(static_cast<int>(frames.size()), reader.shape());
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::copy(frames[static_cast<std::size_t>(slot)], video.frame(slot).begin());
    return video;
}

FluxVideo sci_stand_in(const std::string& scene, int slots, FrameShape shape) {
    const Scene source(scene_from_name(scene), {.slots = slots, .shape = shape});
    FluxVideo video(slots, shape);
    for (int slot = 0; slot < slots; ++slot) {
        source.render(slot, video.frame(slot));
        for (float& light : video.frame(slot)) light = std::pow(std::min(light, 1.0F), 1 / 2.2F);
    }
    return video;
}

NpyVolume random_masks(FrameShape shape, std::uint64_t seed) {
    return drawn_masks(shape, seed, [](std::uint32_t word) { return word & 1U; });
}

NpyVolume grey_masks(FrameShape shape, std::uint64_t seed) {
    return drawn_masks(shape, seed, [](std::uint32_t word) { return word * 0x1p-32; });
}

NpyVolume blurred_masks(const NpyVolume& masks) {
    NpyVolume result = masks;
    std::size_t i = 0;
    for (int frame = 0; frame < masks.layers; ++frame)
        for (int row = 0; row < masks.rows; ++row)
            for (int col = 0; col < masks.cols; ++col) {
                double sum = 0;
                for (int r = -1; r <= 1; ++r)
                    for (int c = -1; c <= 1; ++c)
                        sum += (2 - std::abs(r)) * (2 - std::abs(c)) *
                               masks.at(frame, std::clamp(row + r, 0, masks.rows - 1),
                                        std::clamp(col + c, 0, masks.cols - 1));
                result.values[i++] = sum / 16;
            }
    return result;
}

double sci_psnr_db(const FluxVideo& video, const NpyVolume& masks, const SciSensor& sensor,
                   const DecodeOptions& options) {
    const FrameShape shape = video.shape();
    if (masks.layers != kSciFrames || masks.rows != shape.rows || masks.cols != shape.cols)
        throw InputError("masks",
                         fmt::format("are {} x {} x {}, not {} x {} x {}", masks.layers, masks.rows,
                                     masks.cols, kSciFrames, shape.rows, shape.cols));
    const TemporaryFolder folder;
    write_stream(video, mask_schedule(masks, "masks"), sensor, folder / "clip.stipple");
    StreamReader reader(folder / "clip.stipple", ReadPolicy::kStrict);
    QualityMeter meter(shape, {.max_value = 1});
    decode(reader, options, [&](std::int64_t slot, std::span<const float> frame) {
        meter.add(frame, video.frame(static_cast<int>(slot)));
        return true;
    });
    return meter.quality().psnr_frame_mean_db;
}

}  // namespace stipple
