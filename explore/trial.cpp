#include "explore/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/parsed_number.h"
#include "core/version.h"
#include "decoder/reconstruct.h"
#include "explore/dictionary_file.h"
#include "explore/trial_picture.h"
#include "io/footage_reader.h"
#include "readout/stream_recorder.h"
#include "readout/timing/readout_rate.h"
#include "scenes/scene.h"
#include "stream/stream_reader.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

void check(const KeepGoing& keep_going) {
    if (!keep_going()) throw TrialStopped();
}

TrialLight render_scene(const Space& space, const std::string& name, const KeepGoing& keep_going) {
    const Scene scene(scene_from_name(name), {.slots = space.frames, .shape = space.scene});
    TrialLight light{FluxVideo(space.frames, space.scene), {.name = "scene " + name}};
    for (int slot = 0; slot < space.frames; ++slot) {
        check(keep_going);
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
            name[section.size()] == '.' && !point[i].empty())
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

TimedWindow timed_window(const Space& space, SensorChoice choice, const SensorSetup& setup) {
    TimedWindow window{setup.timing, setup.schedule, setup.shape};
    if (!space.readout_sensor.empty()) {
        choice.sensor = space.readout_sensor;
        choice.settings.clear();
        const SensorDescription sensor = read_sensor_file(choice);
        if (!sensor.timing) throw InputError("readout.sensor " + choice.sensor, no_timing_text());
        window.timing = sensor.timing;
        window.keys = sensor.origin->keys;
        window.shape = {.rows = window.timing->rows, .cols = window.timing->cols, .planes = 1};
    }
    if (space.readout.rows > 0) window.shape = space.readout;
    if (window.timing)
        window.schedule = set_up_schedule(choice, window.shape, window.timing->addressing);
    return window;
}

/// Rate, bandwidth and energy, by the timing of the sensor if it has one.
void add_readout(const Trial& trial, double bits_per_slot, TrialFigures& figures) {
    figures.slots_per_second = 1e6 / trial.setup.params.slot_us;
    figures.limited_by = "slot";
    if (const TimedWindow& window = trial.window; window.timing) {
        const ReadoutRate rate = rate_of(*window.timing, window.schedule.schedule, window.shape);
        const double period = window.schedule.schedule.period_slots();
        figures.readout_slots_per_second = rate.coded_hz;
        if (rate.coded_hz < figures.slots_per_second) {
            figures.slots_per_second = rate.coded_hz;
            figures.limited_by = name_of(rate.slowest.limit);
        }
        bits_per_slot = static_cast<double>(rate.period.bits) / period;
        figures.energy_uj_per_slot = 1e-6 * rate.period.energy_pj / period;
    }
    figures.megabits_per_second = 1e-6 * bits_per_slot * figures.slots_per_second;
}

/// Removes a stream that only its trial needs.
struct RemovedStream {
    const fs::path& file;
    ~RemovedStream() {
        std::error_code error;
        fs::remove(file, error);
    }
};

/// The figures of the recorder; the stream is in place afterwards.
void record(const Trial& trial, const FluxVideo& truth, const fs::path& stream,
            const KeepGoing& keep_going, TrialFigures& figures) {
    StreamRecorder recorder(stream, trial.setup, {.force = true});
    for (int slot = 0; slot < trial.slots; ++slot) {
        check(keep_going);
        recorder.expose(truth.frame(slot));
    }
    recorder.finish();
    add_readout(trial, static_cast<double>(recorder.payload_bits()) / trial.slots, figures);
    figures.light_throughput = recorder.light_throughput();
}

/// Decodes with `options` and hands each frame to `take`, until that returns false.
DecodeReport decode_stream(const fs::path& stream, const DecodeOptions& options,
                           const FrameSink& take, const KeepGoing& keep_going) {
    StreamReader reader(stream);
    const DecodeReport report = decode(
        reader, options,
        [&](std::int64_t slot, std::span<const float> frame) {
            return take(slot, frame) && keep_going();
        },
        [&](double) { return keep_going(); });
    check(keep_going);
    return report;
}

/// The method and its options; `keys` gets what identifies them: the given keys as lines of TOML, a
/// dictionary by its bytes.
DecodeOptions decoding_of(const std::string& method, std::vector<std::string> settings,
                          std::string& keys) {
    Config config(settings, "decoder");
    DecodeOptions options = read_decode_options(decode_method_from_name(method), config);
    read_dictionary(options);
    std::erase_if(settings, [](const std::string& s) { return s.starts_with("dictionary="); });
    keys = Config(settings).as_toml("");
    if (const std::string& file = options.hitomi2011.dictionary_file; !file.empty())
        keys += fmt::format("# dictionary {}\n", origin_of(file, {}, [] {}).sha256);
    return options;
}

}  // namespace

bool is_scene(const std::string& footage) {
    return std::ranges::find(scenes(), footage, &NamedScene::name) != scenes().end();
}

QualityOptions trial_quality(int slots) {
    return {.margin = usual_margin(slots), .max_value = kBrightestLight};
}

TrialLight read_light(const Space& space, const std::string& footage, const KeepGoing& keep_going) {
    if (is_scene(footage)) return render_scene(space, footage, keep_going);
    FootageReader reader(footage);
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    bool more = reader.read(frame);
    for (; more && std::cmp_less(frames.size(), space.frames); more = reader.read(frame)) {
        check(keep_going);
        frames.push_back(frame);
    }
    if (frames.empty()) throw InputError(footage, "has no frame");
    TrialLight light{FluxVideo(static_cast<int>(frames.size()), reader.shape()),
                     origin_of(footage, {}, [&] { check(keep_going); }), !more};
    for (std::size_t i = 0; i < frames.size(); ++i)
        std::ranges::copy(frames[i], light.video.frame(static_cast<int>(i)).begin());
    return light;
}

Trial set_up_trial(const Space& space, const SpacePoint& point, const TrialLight& light,
                   int slots) {
    const SensorChoice choice{.sensor = space.value(point, "sensor"),
                              .schedule = space.value(point, "schedule"),
                              .settings = settings_of(space, point, "sensor"),
                              .schedule_settings = settings_of(space, point, "schedule"),
                              .seed = seed_of(space.value(point, "seed"))};
    const std::string& method = space.value(point, "method");
    std::string decoder_keys;
    DecodeOptions decoding =
        decoding_of(method, settings_of(space, point, "decoder"), decoder_keys);
    SensorSetup setup = set_up_sensor(choice, light.video.shape());
    const FrameShape shape = light.video.shape();
    TimedWindow window = timed_window(space, choice, setup);
    const int recorded = std::min(slots, light.video.slots());
    std::string identity = fmt::format(
        "version {}\nslots {} rows {} cols {} planes {}\nreadout {} x {} {}\n{}\nmethod {}\n{}",
        version(), recorded, shape.rows, shape.cols, shape.planes, window.shape.rows,
        window.shape.cols, window.keys, provenance_of(setup, light.origin),
        method, decoder_keys);
    return {std::move(setup), std::move(window), std::move(decoding), recorded,
            std::move(identity)};
}

TrialOutcome run_trial(const Trial& trial, const TrialLight& light, const fs::path& stream,
                       const KeepGoing& keep_going) {
    const FluxVideo& truth = light.video;
    const RemovedStream removed{stream};
    TrialFigures figures;
    TrialPicture picture(truth.shape());
    record(trial, truth, stream, keep_going, figures);
    const int shown = trial.slots / 2;
    const bool is_naive = trial.decoding.method == DecodeMethod::kNaive;
    QualityMeter meter(truth.shape(), trial_quality(trial.slots));
    const auto take = [&](std::int64_t slot, std::span<const float> frame) {
        const auto reference = truth.frame(static_cast<int>(slot));
        meter.add(frame, reference);
        if (slot == shown) {
            picture.put(TrialPicture::kTruth, reference);
            picture.put(TrialPicture::kDecoded, frame);
            picture.put_error(frame, reference);
            if (is_naive) picture.put(TrialPicture::kNaive, frame);
        }
        return true;
    };
    figures.decode_seconds = decode_stream(stream, trial.decoding, take, keep_going).seconds;
    const auto take_naive = [&](std::int64_t slot, std::span<const float> frame) {
        if (slot == shown) picture.put(TrialPicture::kNaive, frame);
        return slot < shown;
    };
    if (!is_naive) decode_stream(stream, {.method = DecodeMethod::kNaive}, take_naive, keep_going);
    const VideoQuality quality = meter.quality();
    figures.psnr_db = quality.psnr_db;
    figures.psnr_gamma_db = quality.psnr_gamma_db;
    figures.pu21_psnr_db = quality.pu21_psnr_db;
    figures.dynamic_range_stops = dynamic_range_stops(trial.setup);
    return {figures, picture.pixels()};
}

}  // namespace stipple
