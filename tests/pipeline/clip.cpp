#include "tests/pipeline/clip.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/config.h"
#include "decoder/decode_options.h"
#include "decoder/measurements.h"
#include "io/footage_reader.h"
#include "readout/emulator.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"
#include "sensor_model/sensor_config.h"
#include "sensor_model/slot_light.h"
#include "tests/support/footage_folder.h"
#include "tests/support/source_tree.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr double kBrightest = 2;  // full scale / photons per unit
constexpr std::uint64_t kSeed = 1;

std::optional<FluxVideo> read_clip(const std::string& name, bool luminance) {
    const auto folder = footage_clip(name);
    if (!folder) return {};
    FootageReader reader(
        *folder, {.transfer = Transfer::kLinear, .luminance = luminance, .max_value = kBrightest});
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    while (reader.read(frame)) frames.push_back(frame);
    FluxVideo video(static_cast<int>(frames.size()), reader.shape());
    for (int slot = 0; slot < video.slots(); ++slot)
        std::ranges::copy(frames[static_cast<std::size_t>(slot)], video.frame(slot).begin());
    return video;
}

/// A sensor with as many charge stores as the schedule takes.
SensorSetup setup_of(const NamedSchedule& named, FrameShape footage, const SensorParams& sensor,
                     std::uint64_t seed) {
    SensorSetup setup{
        .params = sensor, .schedule = named, .shape = footage, .footage = footage, .seed = seed};
    setup.params.charge_stores = named.schedule.charge_stores();
    return setup;
}

void write_stream(const FluxVideo& video, const SensorSetup& setup,
                  const std::filesystem::path& file) {
    StreamRecorder recorder(file, setup, {.force = true});
    for (int slot = 0; slot < video.slots(); ++slot) recorder.expose(video.frame(slot));
    recorder.finish();
}

}  // namespace

std::optional<FluxVideo> luminance_clip(const std::string& name) {
    return read_clip(name, true);
}

std::optional<FluxVideo> colour_clip(const std::string& name) {
    auto video = read_clip(name, false);
    if (video && video->shape().planes != 3) return {};
    return video;
}

FluxVideo middle(const FluxVideo& video, int side, int slots) {
    const FrameShape whole = video.shape();
    const FrameShape shape{std::min(side, whole.rows), std::min(side, whole.cols), 1};
    FluxVideo crop(std::min(slots, video.slots()), shape);
    for (int slot = 0; slot < crop.slots(); ++slot)
        for (int row = 0; row < shape.rows; ++row)
            for (int col = 0; col < shape.cols; ++col)
                crop.plane(slot, 0)(row, col) = video.plane(slot, 0)(
                    row + (whole.rows - shape.rows) / 2, col + (whole.cols - shape.cols) / 2);
    return crop;
}

NamedSchedule schedule_of(const std::string& name, FrameShape shape) {
    Config config(find_config(ConfigKind::kSchedules, name), {});
    NamedSchedule schedule = read_schedule(config, shape, kSeed);
    config.reject_unknown_keys();
    return schedule;
}

void write_recording(const FluxVideo& video, const std::string& schedule,
                     const std::filesystem::path& file) {
    write_recording(video, schedule_of(schedule, video.shape()), kSeed, file);
}

void write_recording(const FluxVideo& video, const NamedSchedule& named, std::uint64_t seed,
                     const std::filesystem::path& file) {
    write_stream(video, setup_of(named, video.shape(), {}, seed), file);
}

SensorParams sensor_of(const std::string& name, const std::vector<std::string>& settings,
                       double light) {
    Config config(find_config(ConfigKind::kSensors, name), settings);
    SensorParams sensor = read_sensor(config);
    sensor.photons_per_unit *= light;
    validate(sensor);
    return sensor;
}

double clipping_light(const SensorParams& sensor) {
    return std::min(sensor.full_scale_e, sensor.full_well_e) / sensor.electrons_per_unit();
}

void write_recording(const FluxVideo& video, const NamedSchedule& named, const SensorParams& sensor,
                     const std::filesystem::path& file) {
    write_stream(video, setup_of(named, video.shape(), sensor, kSeed), file);
}

void write_mosaic(const FluxVideo& video, ColourFilter cfa, const NamedSchedule& named,
                  const std::filesystem::path& file) {
    const SensorSetup setup = setup_of(
        named, {.rows = video.shape().rows, .cols = video.shape().cols, .planes = 1}, {}, kSeed);
    StreamHeader header = stream_header_of(setup, "");
    header.cfa = cfa;
    StreamWriter writer(file, header);
    Emulator emulator(setup);
    std::vector<float> mosaic(video.shape().pixels());
    for (int slot = 0; slot < video.slots(); ++slot) {
        take_mosaic(cfa, video.shape(), video.frame(slot), mosaic);
        for (const SamplePacket& packet : emulator.expose(mosaic)) writer.write(packet);
    }
    writer.finish();
}

DecodeOptions options_of(DecodeMethod method) {
    DecodeOptions options{.method = method};
    if (method == DecodeMethod::kLearned || method == DecodeMethod::kLearnedFast)
        options.learned.refine =
            refinement_of(project_path("config/models/refinement.safetensors").string());
    return options;
}

FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method,
                         std::vector<SiteCalibration> sites, ResponseTable response) {
    StreamReader reader(file, ReadPolicy::kStrict);
    reader.use_sites(std::move(sites), std::move(response));
    FluxVideo video(static_cast<int>(reader.slots().value()), decoded_shape(reader.header()));
    decode(reader, options_of(method), [&](std::int64_t slot, std::span<const float> frame) {
        std::ranges::copy(frame, video.frame(static_cast<int>(slot)).begin());
        return true;
    });
    return video;
}

VideoQuality quality_of(const FluxVideo& decoded, const FluxVideo& truth) {
    QualityMeter meter(truth.shape(), {.margin = 4, .max_value = kBrightest});
    for (int slot = 0; slot < truth.slots(); ++slot)
        meter.add(decoded.frame(slot), truth.frame(slot));
    return meter.quality();
}

VideoQuality quality_of(const FluxVideo& video, const std::string& schedule, DecodeMethod method) {
    return quality_of(video, schedule_of(schedule, video.shape()), kSeed, method);
}

VideoQuality quality_of(const FluxVideo& video, const NamedSchedule& schedule, std::uint64_t seed,
                        DecodeMethod method) {
    const TemporaryFolder folder;
    write_recording(video, schedule, seed, folder / "clip.stipple");
    return quality_of(read_recording(folder / "clip.stipple", method), video);
}

}  // namespace stipple
