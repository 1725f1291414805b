#include "tests/pipeline/clip.h"

#include <algorithm>
#include <vector>

#include "core/config.h"
#include "core/footage_reader.h"
#include "readout/coded_sensor.h"
#include "readout/schedule_catalogue.h"
#include "stream/stream_writer.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/footage_folder.h"

namespace stipple {
namespace {

constexpr double kBrightest = 2;  // full scale / photons per unit
constexpr std::uint64_t kSeed = 1;

NamedSchedule schedule_of(const std::string& name, FrameShape shape) {
    Config config(find_config("schedules", name), {});
    NamedSchedule schedule = read_schedule(config, shape, kSeed);
    config.reject_unknown_keys();
    return schedule;
}

}  // namespace

std::optional<FluxVideo> luminance_clip(const std::string& name) {
    const auto folder = footage_folder() / name;
    if (!std::filesystem::exists(folder)) return {};
    FootageReader reader(
        folder, {.transfer = Transfer::kLinear, .luminance = true, .max_value = kBrightest});
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    while (reader.read(frame)) frames.push_back(frame);
    FluxVideo video(static_cast<int>(frames.size()), reader.shape());
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::copy(frames[static_cast<std::size_t>(slot)], video.frame(slot).begin());
    return video;
}

void write_recording(const FluxVideo& video, const std::string& schedule,
                     const std::filesystem::path& file) {
    write_recording(video, schedule_of(schedule, video.shape()), kSeed, file);
}

void write_recording(const FluxVideo& video, const NamedSchedule& named, std::uint64_t seed,
                     const std::filesystem::path& file) {
    const SensorParams params{.charge_stores = named.schedule.charge_stores()};
    StreamWriter writer(file, {.shape = video.shape(),
                               .slot_us = params.slot_us,
                               .calibration = calibration_of(params),
                               .schedule = named.schedule,
                               .schedule_source = named.source,
                               .schedule_name = named.name,
                               .provenance = ""});
    CodedSensor sensor(params, video.shape(), named.schedule, seed);
    SamplePacket packet;
    for (int slot = 0; slot < video.slots(); ++slot) {
        sensor.expose(video.frame(slot), packet);
        writer.write(packet);
    }
    writer.finish();
}

FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method) {
    StreamReader reader(file, ReadPolicy::kStrict);
    FluxVideo video(static_cast<int>(reader.slots().value()), reader.header().shape);
    decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
        std::ranges::copy(frame, video.frame(static_cast<int>(slot)).begin());
        return true;
    });
    return video;
}

VideoQuality quality_of(const FluxVideo& video, const std::string& schedule, DecodeMethod method) {
    return quality_of(video, schedule_of(schedule, video.shape()), kSeed, method);
}

VideoQuality quality_of(const FluxVideo& video, const NamedSchedule& schedule, std::uint64_t seed,
                        DecodeMethod method) {
    const TemporaryFolder folder;
    write_recording(video, schedule, seed, folder / "clip.stipple");
    const FluxVideo decoded = read_recording(folder / "clip.stipple", method);
    QualityMeter meter(video.shape(), {.margin = 4, .max_value = kBrightest});
    for (int slot = 0; slot < video.slots(); ++slot)
        meter.add(decoded.frame(slot), video.frame(slot));
    return meter.quality();
}

}  // namespace stipple
