#include "study/explore/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <deque>
#include <limits>
#include <list>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/peak_memory.h"
#include "core/version.h"
#include "decoder/reconstruct.h"
#include "io/footage_reader.h"
#include "readout/rig_figures.h"
#include "readout/rig_recorder.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"
#include "session/decode_setup.h"
#include "stream/stream_reader.h"
#include "study/explore/point_view.h"
#include "study/scenes/scene.h"

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

/// Stops between the brightest light that the shortest exposure of any sensor measures and the
/// light that is as strong as the read noise of the longest one.
double sample_range_stops(const std::vector<SensorSetup>& setups) {
    double brightest = 0, darkest = std::numeric_limits<double>::infinity();
    for (const SensorSetup& setup : setups) {
        const ExposureSchedule& schedule = setup.schedule.schedule;
        // The quantisation of the converter is noise too, of a uniform distribution.
        const double noise_e = std::hypot(setup.params.temporal_read_noise_e(),
                                          setup.params.gain_e_per_dn() / std::sqrt(12.0));
        for (int row = 0; row < schedule.tile_rows(); ++row)
            for (int col = 0; col < schedule.tile_cols(); ++col)
                for (const Exposure& exposure : schedule.exposures(row, col)) {
                    const double gain = setup.params.electrons_per_unit() *
                                        schedule.light_slots(row, col, exposure);
                    brightest = std::max(brightest, setup.params.saturation_e() / gain);
                    darkest = std::min(darkest, noise_e / gain);
                }
    }
    return std::log2(brightest / darkest);
}

TimedWindow timed_window(const Space& space, const PointView& view, SensorChoice choice,
                         const SensorSetup& setup) {
    TimedWindow window{setup.timing, setup.schedule, setup.shape};
    FrameShape array = space.readout;
    if (!space.readout_sensor.empty()) {
        choice.sensor = space.readout_sensor;
        choice.settings.clear();
        const SensorDescription sensor = read_sensor_file(choice);
        if (!sensor.timing) throw InputError("readout.sensor " + choice.sensor, no_timing_text());
        window.timing = sensor.timing;
        window.keys = sensor.origin->keys;
        if (array.rows == 0)
            array = {.rows = window.timing->rows, .cols = window.timing->cols, .planes = 1};
    }
    if (array.rows > 0) window.shape = view.binned(view.window(array));
    if (window.timing)
        window.schedule = set_up_schedule(choice, window.shape, window.timing->addressing);
    return window;
}

/// Bits a slot of the code of all pixels: one each, unless all pixels of a row expose alike.
double code_bits(const TimedWindow& window) {
    const ExposureSchedule& schedule = window.schedule.schedule;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 1; col < schedule.tile_cols(); ++col)
            if (!std::ranges::equal(schedule.exposures(row, col), schedule.exposures(row, 0)))
                return static_cast<double>(window.shape.pixels());
    return 0;
}

/// Rate, bandwidth and energy of all sensors, by their timing if they have one. The slowest one
/// limits the rate.
void add_readout(const Trial& trial, double bits_per_slot, TrialFigures& figures) {
    figures.slots_per_second = 1e6 / trial.setups.front().params.slot_us;
    figures.limited_by = "slot";
    if (std::ranges::all_of(trial.windows,
                            [](const TimedWindow& w) { return w.timing.has_value(); })) {
        bits_per_slot = 0;
        figures.energy_uj_per_slot = 0;
        figures.readout_slots_per_second = std::numeric_limits<double>::infinity();
        for (const TimedWindow& window : trial.windows) {
            const ReadoutRate rate =
                rate_of(*window.timing, window.schedule.schedule, window.shape,
                        slot_clocks(*window.timing, trial.setups.front().params.slot_us));
            const double period = window.schedule.schedule.period_slots();
            figures.readout_slots_per_second =
                std::min(figures.readout_slots_per_second, rate.coded_hz);
            if (rate.coded_hz < figures.slots_per_second) {
                figures.slots_per_second = rate.coded_hz;
                figures.limited_by = name_of(rate.slowest.limit);
            }
            bits_per_slot += static_cast<double>(rate.period.bits) / period;
            figures.energy_uj_per_slot += 1e-6 * rate.period.energy_pj / period;
        }
    }
    figures.megabits_per_second = 1e-6 * bits_per_slot * figures.slots_per_second;
    figures.code_megabits_per_second = 0;
    for (const TimedWindow& window : trial.windows)
        figures.code_megabits_per_second += 1e-6 * code_bits(window) * figures.slots_per_second;
}

/// Samples of all sensors in a steady slot over the voxels of the whole clip.
double samples_per_voxel(const std::vector<SensorSetup>& setups, FrameShape clip) {
    double samples = 0;
    for (const SensorSetup& setup : setups)
        samples += setup.schedule.schedule.samples_per_pixel_slot() *
                   static_cast<double>(setup.shape.sites());
    return samples / static_cast<double>(clip.sites());
}

/// The files of a trial's streams, in the order of its sensors; removed in the end.
class TrialStreams {
  public:
    TrialStreams(const fs::path& first, std::size_t count) : files_{first} {
        while (files_.size() < count)
            files_.push_back(fs::path(first).replace_extension(
                fmt::format("{}{}", files_.size() + 1, first.extension().string())));
    }
    TrialStreams(const TrialStreams&) = delete;
    TrialStreams& operator=(const TrialStreams&) = delete;
    ~TrialStreams() {
        std::error_code error;
        for (const fs::path& file : files_) fs::remove(file, error);
    }
    [[nodiscard]] const std::vector<fs::path>& files() const { return files_; }

  private:
    std::vector<fs::path> files_;
};

/// The figures of the recorders of `light`; the streams are in place afterwards.
void record(const Trial& trial, const FluxVideo& light, const TrialStreams& streams,
            const KeepGoing& keep_going, TrialFigures& figures) {
    std::list<RigRecorder> recorders;
    for (std::size_t i = 0; i < trial.setups.size(); ++i)
        recorders.emplace_back(trial.rig.sensors[i], trial.setups[i], streams.files()[i],
                               StreamRecorderOptions{.force = true});
    for (int slot = 0; slot < trial.slots; ++slot) {
        check(keep_going);
        for (RigRecorder& recorder : recorders) recorder.expose(slot, light.frame(slot));
    }
    RigTotals totals;
    for (RigRecorder& recorder : recorders) {
        recorder.finish(trial.slots);
        totals.add(recorder.recorder(), recorder.sensor().share);
    }
    add_readout(trial, totals.bits_per_slot, figures);
    figures.light_throughput = totals.light_collected;
    figures.sample_range_stops = sample_range_stops(trial.setups);
}

/// Hands each frame to `take` in the size of the clip.
FrameSink enlarging(const Trial& trial, const FrameSink& take) {
    if (trial.view.binning == 1) return take;
    return [&trial, take](std::int64_t slot, std::span<const float> frame) {
        const FrameShape shape = trial.setups.front().footage;
        return take(slot, enlarged_frame(frame, shape, trial.view.binning));
    };
}

/// Decodes with `options` and hands each frame, in the size of the clip, to `take`, until that
/// returns false.
DecodeReport decode_streams(const Trial& trial, const TrialStreams& files,
                            const DecodeOptions& options, const FrameSink& take,
                            const ProgressCallback& progress) {
    std::deque<StreamReader> readers;
    std::vector<RigStream> streams;
    for (const RigSensor& sensor : trial.rig.sensors) {
        readers.emplace_back(files.files()[readers.size()]);
        streams.push_back({readers.back(), {sensor.from_reference, sensor.phase_slots}});
    }
    return decode_rig(streams, options, enlarging(trial, take), progress);
}

/// Seconds that the decoder takes; its frames go to `take` as above.
double decode_by_own(const Trial& trial, const fs::path& stream, const FrameSink& take) {
    const auto begin = std::chrono::steady_clock::now();
    const FluxVideo video = trial.own->decode(stream, trial.own_options);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    check_video(*trial.own, video, trial.slots, trial.setups.front().footage);
    const FrameSink sink = enlarging(trial, take);
    for (int slot = 0; slot < video.slots(); ++slot) sink(slot, video.frame(slot));
    return taken.count();
}

/// Decodes by the method of the trial, as decode_streams, and measures what it takes.
void decode_measured(const Trial& trial, const TrialStreams& streams, const FrameSink& take,
                     const ProgressCallback& progress, TrialFigures& figures) {
    const PeakMemory memory;
    figures.decode_seconds =
        trial.own ? decode_by_own(trial, streams.files().front(), take)
                  : decode_streams(trial, streams, trial.decoding, take, progress).seconds;
    if (const auto bytes = memory.bytes())
        figures.decode_megabytes = 1e-6 * static_cast<double>(*bytes);
}

/// The options of an own decoder, lines of TOML. \throws InputError for a rig.
std::string own_options_of(const Space& space, const SpacePoint& point, const OwnDecoder& decoder) {
    if (!space.rig(point).empty())
        throw InputError(fmt::format("decoder \"{}\"", decoder.name),
                         "decodes one stream, but the point has a rig");
    return Config(space.settings(point, "decoder"), "decoder").as_toml("");
}

/// The method and its options; `keys` gets what identifies them: the given keys as lines of TOML, a
/// file by its bytes.
DecodeOptions decoding_of(const std::string& method, std::vector<std::string> settings,
                          std::string& keys) {
    Config config(settings, "decoder");
    DecodeOptions options = read_decode_options(decode_method_from_name(method), config);
    read_option_file(options);
    const bool network = options.method == DecodeMethod::kPlugAndPlay;
    const std::string key = network ? "denoiser" : "dictionary";
    std::erase_if(settings, [&](const std::string& s) { return s.starts_with(key + "="); });
    keys = Config(settings).as_toml("");
    if (const std::string file = option_file(options); !file.empty())
        keys += fmt::format("# {} {}\n", key, origin_of(file, {}, [] {}).sha256);
    return options;
}

}  // namespace

bool is_scene(const std::string& footage) {
    return std::ranges::find(scenes(), footage, &NamedScene::name) != scenes().end();
}

QualityOptions trial_quality(int slots) {
    return {.margin = usual_margin(slots), .max_value = kBrightestLight};
}

TrialLight read_light(const Space& space, const std::string& footage, const FootageOptions& reading,
                      const KeepGoing& keep_going) {
    if (is_scene(footage)) {
        if (reading.transfer || reading.luminance || reading.raw || reading.scale != 1 ||
            reading.min_value || reading.part != FootagePart())
            throw InputError(footage,
                             "is an embedded scene, which the options of footage do not change; "
                             "write it by \"stipple synth\" and give that file");
        return render_scene(space, footage, keep_going);
    }
    FootageReader reader(footage, reading);
    std::vector<std::vector<float>> frames;
    std::vector<float> frame(reader.shape().sites());
    bool more = reader.read(frame);
    for (; more && std::cmp_less(frames.size(), space.frames); more = reader.read(frame)) {
        check(keep_going);
        frames.push_back(frame);
    }
    if (frames.empty()) throw InputError(footage, "has no frame");
    TrialLight light{FluxVideo(static_cast<int>(frames.size()), reader.shape()),
                     origin_of(footage, reading, [&] { check(keep_going); }), !more,
                     reader.take_warnings()};
    for (std::size_t i = 0; i < frames.size(); ++i)
        std::ranges::copy(frames[i], light.video.frame(static_cast<int>(i)).begin());
    return light;
}

Trial set_up_trial(const Space& space, const SpacePoint& point, const TrialLight& light, int slots,
                   ComparedSlots compared) {
    PointRig of_point = rig_of(space, point);
    const std::string& method = space.value(point, "method");
    const OwnDecoder* const own = space.own_decoder(point);
    const std::string own_options = own == nullptr ? "" : own_options_of(space, point, *own);
    std::string decoder_keys = own_options;
    DecodeOptions decoding;
    if (own == nullptr)
        decoding = decoding_of(method, space.settings(point, "decoder"), decoder_keys);
    else
        decoder_keys += fmt::format("# own decoder, version {}\n", own->version);
    const FrameShape shape = light.video.shape();
    Trial trial{.rig = std::move(of_point.rig),
                .setups = {},
                .windows = {},
                .view = view_of(space, point),
                .decoding = std::move(decoding),
                .own = own == nullptr ? std::nullopt : std::optional<OwnDecoder>(*own),
                .own_options = own_options,
                .slots = std::min(slots, light.video.slots()),
                .compared = compared,
                .identity = {}};
    const PointView& view = trial.view;
    trial.setups = set_up_rig(trial.rig, view.binned(view.window(shape)));
    for (std::size_t i = 0; i < trial.setups.size(); ++i)
        trial.windows.push_back(
            timed_window(space, view, trial.rig.sensors[i].choice, trial.setups[i]));
    const FrameShape window = trial.windows.front().shape;
    trial.identity = fmt::format(
        "version {}\nslots {} compared {}:{} rows {} cols {} planes {}\nreadout {} x {} {}\n"
        "window_rows {} binning {} {}\n{}method {}\n{}",
        version(), trial.slots, compared.begin, compared.end, shape.rows, shape.cols, shape.planes,
        window.rows, window.cols, trial.windows.front().keys, view.rows, view.binning,
        name_in(kBinningModes, view.mode), of_point.keys, method, decoder_keys);
    for (const SensorSetup& setup : trial.setups)
        trial.identity += "\n" + provenance_of(setup, light.origin);
    if (view.binning > 1)
        for (SensorSetup& setup : trial.setups) {
            setup.params = binned(setup.params, view.binning, view.mode);
            setup.origin.reset();
        }
    return trial;
}

TrialOutcome run_trial(const Trial& trial, const TrialLight& light, const fs::path& stream,
                       const KeepGoing& keep_going, const std::function<void(double)>& progress) {
    const PointView& view = trial.view;
    const FluxVideo window = view.rows < 1 ? window_light(light.video, view) : FluxVideo();
    const FluxVideo& truth = view.rows < 1 ? window : light.video;
    const TrialStreams streams(stream, trial.setups.size());
    TrialFigures figures;
    TrialPicture picture(truth.shape());
    if (view.binning > 1)
        record(trial, binned_light(truth, view), streams, keep_going, figures);
    else
        record(trial, truth, streams, keep_going, figures);
    figures.samples_per_voxel = samples_per_voxel(trial.setups, light.video.shape());
    figures.field_of_view = static_cast<double>(truth.shape().pixels()) /
                            static_cast<double>(light.video.shape().pixels());
    figures.compared_slots = fmt::format("{}:{}", trial.compared.begin, trial.compared.end);
    const int shown = trial.slots / 2;
    const bool is_naive = !trial.own && trial.decoding.method == DecodeMethod::kNaive;
    QualityMeter meter(truth.shape(), {.max_value = kBrightestLight});
    const auto take = [&](std::int64_t slot, std::span<const float> frame) {
        const auto reference = truth.frame(static_cast<int>(slot));
        if (slot >= trial.compared.begin && slot < trial.compared.end) meter.add(frame, reference);
        if (slot == shown) {
            picture.put(TrialPicture::kTruth, reference);
            picture.put(TrialPicture::kDecoded, frame);
            picture.put_error(frame, reference);
            if (is_naive) picture.put(TrialPicture::kNaive, frame);
        }
        return true;
    };
    const auto tell = [&](double slots) {
        progress(slots / trial.slots);
        return keep_going();
    };
    decode_measured(trial, streams, take, tell, figures);
    check(keep_going);
    const auto take_naive = [&](std::int64_t slot, std::span<const float> frame) {
        if (slot == shown) picture.put(TrialPicture::kNaive, frame);
        return slot < shown;
    };
    if (!is_naive)
        decode_streams(trial, streams, {.method = DecodeMethod::kNaive}, take_naive,
                       [&](double) { return keep_going(); });
    check(keep_going);
    const VideoQuality quality = meter.quality();
    figures.psnr_db = quality.psnr_db;
    figures.psnr_gamma_db = quality.psnr_gamma_db;
    figures.pu21_psnr_db = quality.pu21_psnr_db;
    return {figures, picture.pixels()};
}

}  // namespace stipple
