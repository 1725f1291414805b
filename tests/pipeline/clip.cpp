#include "tests/pipeline/clip.h"

#include <algorithm>
#include <span>
#include <vector>

#include "core/config.h"
#include "core/footage_reader.h"
#include "decoder/measurements.h"
#include "readout/coded_sensor.h"
#include "readout/schedule_catalogue.h"
#include "sensor_model/colour_mosaic.h"
#include "sensor_model/sensor_config.h"
#include "stream/stream_writer.h"
#include "tests/core/temporary_folder.h"
#include "tests/support/footage_folder.h"

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

SensorParams with_stores_for(const ExposureSchedule& schedule, SensorParams sensor) {
    sensor.charge_stores = schedule.charge_stores();
    return sensor;
}

/// A sensor with a schedule, and the stream that it writes.
class Recorder {
  public:
    Recorder(const NamedSchedule& named, FrameShape shape, ColourFilter cfa,
             const SensorParams& sensor = {})
        : params_(with_stores_for(named.schedule, sensor)),
          header_{.shape = shape,
                  .slot_us = params_.slot_us,
                  .calibration = calibration_of(params_),
                  .schedule = named.schedule,
                  .schedule_source = named.source,
                  .schedule_name = named.name,
                  .provenance = "",
                  .cfa = cfa} {}

    /// The samples of `light(slot)`, frames of the array.
    template <typename Light>
    void write(int slots, std::uint64_t seed, const std::filesystem::path& file,
               const Light& light) const {
        StreamWriter writer(file, header_);
        CodedSensor sensor(params_, header_.shape, header_.schedule, seed);
        SamplePacket packet;
        for (int slot = 0; slot < slots; ++slot) {
            sensor.expose(light(slot), packet);
            writer.write(packet);
        }
        writer.finish();
    }

  private:
    SensorParams params_;
    StreamHeader header_;
};

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
    Config config(find_config("schedules", name), {});
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
    const Recorder recorder(named, video.shape(), ColourFilter::kNone);
    recorder.write(video.slots(), seed, file, [&](int slot) { return video.frame(slot); });
}

SensorParams sensor_of(const std::string& name, const std::vector<std::string>& settings,
                       double light) {
    Config config(find_config("sensors", name), settings);
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
    const Recorder recorder(named, video.shape(), ColourFilter::kNone, sensor);
    recorder.write(video.slots(), kSeed, file, [&](int slot) { return video.frame(slot); });
}

void write_mosaic(const FluxVideo& video, ColourFilter cfa, const NamedSchedule& named,
                  const std::filesystem::path& file) {
    const Recorder recorder(
        named, {.rows = video.shape().rows, .cols = video.shape().cols, .planes = 1}, cfa);
    std::vector<float> mosaic(video.shape().pixels());
    recorder.write(video.slots(), kSeed, file, [&](int slot) {
        take_mosaic(cfa, video.shape(), video.frame(slot), mosaic);
        return std::span<const float>(mosaic);
    });
}

FluxVideo read_recording(const std::filesystem::path& file, DecodeMethod method) {
    StreamReader reader(file, ReadPolicy::kStrict);
    FluxVideo video(static_cast<int>(reader.slots().value()), decoded_shape(reader.header()));
    decode(reader, method, [&](std::int64_t slot, std::span<const float> frame) {
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
