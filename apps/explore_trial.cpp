#include "apps/explore_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "apps/demo_trial.h"
#include "apps/interrupt.h"
#include "core/config.h"
#include "core/error.h"
#include "core/parsed_number.h"
#include "core/version.h"
#include "decoder/reconstruct.h"
#include "io/footage_reader.h"
#include "metrics/video_quality.h"
#include "readout/footage_origin.h"
#include "readout/stream_recorder.h"
#include "readout/timing/readout_rate.h"
#include "scenes/scene.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

bool is_scene(const std::string& name) {
    return std::ranges::find(scenes(), name, &NamedScene::name) != scenes().end();
}

TrialLight render_scene(const Space& space, const std::string& name) {
    const Scene scene(scene_from_name(name), {.slots = space.frames, .shape = space.scene});
    TrialLight light{FluxVideo(space.frames, space.scene), {.name = "scene " + name}};
    for (int slot = 0; slot < space.frames; ++slot) {
        throw_if_stopped();
        scene.render(slot, light.video.frame(slot));
    }
    return light;
}

/// The settings of a point whose keys begin with `section` and a dot, without these.
std::vector<std::string> settings_of(const Space& space, const SpacePoint& point,
                                     std::string_view section) {
    std::vector<std::string> settings;
    for (std::size_t i = 0; i < point.size(); ++i) {
        const std::string& name = space.axes[i].name;
        if (name.starts_with(section) && name.size() > section.size() &&
            name[section.size()] == '.')
            settings.push_back(fmt::format("{}={}", name.substr(section.size() + 1), point[i]));
    }
    return settings;
}

std::uint64_t seed_of(const std::string& text) {
    if (const auto seed = parsed_number<std::uint64_t>(text)) return *seed;
    throw InputError("seed", fmt::format("\"{}\" is no whole number", text));
}

/// Stops between the brightest light that the shortest exposure measures and the light that is as
/// strong as the read noise of the longest one.
double dynamic_range_stops(const SensorSetup& setup) {
    const ExposureSchedule& schedule = setup.schedule.schedule;
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col)) {
                const double slots = schedule.light_slots(row, col, exposure);
                shortest = std::min(shortest, slots);
                longest = std::max(longest, slots);
            }
    // The quantisation of the converter is noise too, of a uniform distribution.
    const double noise_e = std::hypot(setup.params.temporal_read_noise_e(),
                                      setup.params.gain_e_per_dn() / std::sqrt(12.0));
    return std::log2(setup.params.saturation_e() / shortest * longest / noise_e);
}

/// Rate, bandwidth and energy, by the timing of the sensor if it has one.
void add_readout(const Trial& trial, double bits_per_slot, nlohmann::ordered_json& figures) {
    const SensorSetup& setup = trial.setup;
    double slots_hz = 1e6 / setup.params.slot_us;
    std::string limit = "slot";
    std::optional<double> energy_uj;
    if (setup.timing) {
        const ReadoutRate rate = rate_of(*setup.timing, trial.timed.schedule, trial.window);
        const double period = trial.timed.schedule.period_slots();
        if (rate.coded_hz < slots_hz) {
            slots_hz = rate.coded_hz;
            limit = name_of(rate.slowest.limit);
        }
        bits_per_slot = static_cast<double>(rate.period.bits) / period;
        energy_uj = 1e-6 * rate.period.energy_pj / period;
    }
    figures["slots_per_second"] = slots_hz;
    figures["limited_by"] = limit;
    figures["megabits_per_second"] = 1e-6 * bits_per_slot * slots_hz;
    figures["energy_uj_per_slot"] = energy_uj ? nlohmann::ordered_json(*energy_uj) : nullptr;
}

/// Removes a stream that only its trial needs.
struct RemovedStream {
    const fs::path& file;
    ~RemovedStream() {
        std::error_code error;
        fs::remove(file, error);
    }
};

}  // namespace

TrialLight read_light(const Space& space, const std::string& footage) {
    if (is_scene(footage)) return render_scene(space, footage);
    FootageReader reader(footage);
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    while (std::cmp_less(frames.size(), space.frames) && reader.read(frame)) {
        throw_if_stopped();
        frames.push_back(frame);
    }
    TrialLight light{FluxVideo(static_cast<int>(frames.size()), reader.shape()),
                     origin_of(footage, {}, [] { throw_if_stopped(); })};
    for (std::size_t i = 0; i < frames.size(); ++i)
        std::ranges::copy(frames[i], light.video.frame(static_cast<int>(i)).begin());
    return light;
}

Trial set_up_trial(const Space& space, const SpacePoint& point, const TrialLight& light) {
    const SensorChoice choice{.sensor = space.value(point, "sensor"),
                              .schedule = space.value(point, "schedule"),
                              .settings = settings_of(space, point, "sensor"),
                              .schedule_settings = settings_of(space, point, "schedule"),
                              .seed = seed_of(space.value(point, "seed"))};
    const DecodeMethod method = decode_method_from_name(space.value(point, "method"));
    Config config(settings_of(space, point, "decoder"), "decoder");
    const DecodeOptions decoding = read_decode_options(method, config);
    SensorSetup setup = set_up_sensor(choice, light.video.shape());
    const FrameShape shape = light.video.shape();
    const FrameShape window = space.readout.rows > 0 ? space.readout : setup.shape;
    NamedSchedule timed =
        setup.timing ? set_up_schedule(choice, window, setup.timing->addressing) : setup.schedule;
    std::string identity = fmt::format(
        "version {}\nslots {} rows {} cols {} planes {}\nreadout {} x {}\n{}\nmethod {}\n{}",
        version(), light.video.slots(), shape.rows, shape.cols, shape.planes, window.rows,
        window.cols, provenance_of(setup, light.origin), space.value(point, "method"),
        config.as_toml(""));
    return {std::move(setup), std::move(timed), window, decoding, std::move(identity)};
}

nlohmann::ordered_json run_trial(const Trial& trial, const TrialLight& light,
                                 const fs::path& stream) {
    const FluxVideo& truth = light.video;
    const RemovedStream removed{stream};
    StreamRecorder recorder(stream, trial.setup, {.force = true});
    for (int slot = 0; slot < truth.slots(); ++slot) {
        throw_if_stopped();
        recorder.expose(truth.frame(slot));
    }
    recorder.finish();
    StreamReader reader(stream);
    QualityMeter meter(truth.shape(), demo_quality(truth.slots()));
    const DecodeReport report = decode(
        reader, trial.decoding,
        [&](std::int64_t slot, std::span<const float> frame) {
            meter.add(frame, truth.frame(static_cast<int>(slot)));
            return stop_signal() == 0;
        },
        [](double) { return stop_signal() == 0; });
    throw_if_stopped();
    const VideoQuality quality = meter.quality();
    nlohmann::ordered_json figures;
    add_readout(trial,
                static_cast<double>(recorder.payload_bits()) / static_cast<double>(truth.slots()),
                figures);
    figures["light_throughput"] = recorder.light_throughput();
    figures["psnr_db"] = quality.psnr_db;
    figures["psnr_gamma_db"] = quality.psnr_gamma_db;
    figures["pu21_psnr_db"] = quality.pu21_psnr_db;
    figures["dynamic_range_stops"] = dynamic_range_stops(trial.setup);
    figures["decode_seconds"] = report.seconds;
    return figures;
}

}  // namespace stipple
