#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/flux_video.h"
#include "core/geometry.h"
#include "decoder/decode_options.h"
#include "io/png_file.h"
#include "readout/footage_origin.h"
#include "readout/rig.h"
#include "readout/sensor_file.h"
#include "study/decoders/own_decoder.h"
#include "study/explore/point_view.h"
#include "study/explore/space.h"
#include "study/metrics/video_quality.h"

namespace stipple {

/// What a trial costs and how good it is (docs/explore.md). NaN: there is no such figure.
struct TrialFigures {
    static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

    double slots_per_second = kNone;
    std::string limited_by;  ///< "slot", or the part of the readout that limits the rate
    double readout_slots_per_second = kNone;  ///< what the readout allows, with timing
    double megabits_per_second = kNone;
    double code_megabits_per_second = kNone;  ///< of coded sensors; others have 0
    double energy_uj_per_slot = kNone;        ///< of sensors with timing
    double light_throughput = kNone;          ///< of one aperture
    double field_of_view = kNone;             ///< fraction of the pixels of the clip that is seen
    double samples_per_voxel = kNone;         ///< of all sensors
    double psnr_db = kNone;
    double psnr_gamma_db = kNone;
    double pu21_psnr_db = kNone;
    double sample_range_stops = kNone;
    double decode_seconds = kNone;
    double decode_megabytes = kNone;  ///< the most memory that decoding added
    std::string compared_slots = {};  ///< "A:B", those before B
};

/// A column of text of the table.
struct TextColumn {
    std::string_view name;
    std::string TrialFigures::*value;
};

inline constexpr std::array<TextColumn, 2> kTextColumns{
    {{"limited_by", &TrialFigures::limited_by}, {"compared_slots", &TrialFigures::compared_slots}}};

enum class Better : std::uint8_t { kMore, kLess };

/// A column of numbers of the table.
struct FigureColumn {
    std::string_view name;
    std::string_view title;  ///< for people, with the unit
    double TrialFigures::*value;
    Better better;
};

inline constexpr std::array<FigureColumn, 14> kFigureColumns{
    {{"slots_per_second", "slot rate, 1/s", &TrialFigures::slots_per_second, Better::kMore},
     {"readout_slots_per_second", "slot rate of the readout, 1/s",
      &TrialFigures::readout_slots_per_second, Better::kMore},
     {"megabits_per_second", "data rate, Mbit/s", &TrialFigures::megabits_per_second,
      Better::kLess},
     {"code_megabits_per_second", "exposure code, Mbit/s", &TrialFigures::code_megabits_per_second,
      Better::kLess},
     {"energy_uj_per_slot", "energy per slot, uJ", &TrialFigures::energy_uj_per_slot,
      Better::kLess},
     {"light_throughput", "light throughput", &TrialFigures::light_throughput, Better::kMore},
     {"field_of_view", "field of view", &TrialFigures::field_of_view, Better::kMore},
     {"samples_per_voxel", "samples per voxel", &TrialFigures::samples_per_voxel, Better::kLess},
     {"psnr_db", "PSNR, dB", &TrialFigures::psnr_db, Better::kMore},
     {"psnr_gamma_db", "PSNR after 1/2.2, dB", &TrialFigures::psnr_gamma_db, Better::kMore},
     {"pu21_psnr_db", "PU21-PSNR, dB", &TrialFigures::pu21_psnr_db, Better::kMore},
     {"sample_range_stops", "sample range, stops", &TrialFigures::sample_range_stops,
      Better::kMore},
     {"decode_seconds", "decode time, s", &TrialFigures::decode_seconds, Better::kLess},
     {"decode_megabytes", "decode memory, MB", &TrialFigures::decode_megabytes, Better::kLess}}};

/// Light is compared up to this one: full_scale_e / photons_per_unit of the default sensor.
inline constexpr double kBrightestLight = 2;

/// How the video of the demo is compared with the truth: without the first and last 4 of its frames
/// (fewer of short clips), light up to kBrightestLight.
[[nodiscard]] QualityOptions trial_quality(int slots);

/// Asked now and then during long work; false: end it.
using KeepGoing = std::function<bool()>;

/// Thrown where a KeepGoing has said so.
struct TrialStopped {};

/// Light of the trials of a space.
struct TrialLight {
    FluxVideo video;
    FootageOrigin origin;
    bool is_whole = true;                ///< false: the footage has more slots
    std::vector<Message> warnings = {};  ///< of the reader
};

/// Whether `footage` names an embedded scene.
[[nodiscard]] bool is_scene(const std::string& footage);

/// The first slots of an embedded scene, or of a file. \throws InputError, also for a scene with
/// options of reading, TrialStopped.
[[nodiscard]] TrialLight read_light(const Space& space, const std::string& footage,
                                    const FootageOptions& reading, const KeepGoing& keep_going);

/// A window and how it is read.
struct TimedWindow {
    std::optional<ReadoutTiming> timing;  ///< none: the sensor has no clocks
    NamedSchedule schedule;
    FrameShape shape;
    std::string keys = {};  ///< of the sensor that `readout.sensor` names, as lines of TOML
};

/// A point of a space, set up.
struct Trial {
    Rig rig;                           ///< of one sensor, unless the point names a rig
    std::vector<SensorSetup> setups;   ///< of its sensors
    std::vector<TimedWindow> windows;  ///< whose rate, bandwidth and energy are computed
    PointView view;                    ///< what the sensors read
    DecodeOptions decoding;
    std::optional<OwnDecoder> own;  ///< decodes in place of `decoding`
    std::string own_options;        ///< of it
    int slots;                      ///< the first ones of the light are recorded
    ComparedSlots compared;         ///< of these
    std::string identity;           ///< all that determines the result; equal for equal trials
};

/// Precondition: slots > 0, more than the light has are not recorded; `compared` is of these.
/// \throws InputError naming file, line and key of a value that cannot be used.
[[nodiscard]] Trial set_up_trial(const Space& space, const SpacePoint& point,
                                 const TrialLight& light, int slots, ComparedSlots compared);

struct TrialOutcome {
    TrialFigures figures;
    PngPixels picture;  ///< the middle slot (TrialPicture)
};

/// Records the light as `stream`, those of further sensors beside it, decodes them to one video,
/// and removes them. `progress` receives the part of the slots that is decoded, 0..1. \throws
/// InputError, DeviceError, TrialStopped; DecoderFault and what else an OwnDecoder throws.
[[nodiscard]] TrialOutcome run_trial(
    const Trial& trial, const TrialLight& light, const std::filesystem::path& stream,
    const KeepGoing& keep_going, const std::function<void(double)>& progress = [](double) {});

/// A frame of n times as many rows and columns, order (plane, row, col), by a sinc with the window
/// of Lanczos, of 6 x 6 pixels. Beyond the borders light is that of the nearest pixel; negative
/// light becomes 0. A linear interpolation of signals in light, without a model of scenes or noise.
[[nodiscard]] std::vector<float> enlarged_frame(std::span<const float> frame, FrameShape shape,
                                                int n);

/// A slot of a trial in four tiles side by side: truth, naive, decoded, error.
class TrialPicture {
  public:
    static constexpr int kTiles = 4;
    static constexpr int kMaxRows = 120;  ///< of a tile; of larger frames the middle is shown
    static constexpr int kMaxCols = 160;

    enum Tile : std::uint8_t { kTruth, kNaive, kDecoded, kError };

    /// Black.
    explicit TrialPicture(FrameShape frame);

    /// A tile of light by the tone curve of io/tone_map.h. `frame` has the shape of the frame.
    void put(Tile tile, std::span<const float> frame);
    /// The tile of `decoded` - `truth`, mean of the colours, as grey: 128 is none, 255 is
    /// kErrorRange or more too bright, 0 so much too dark.
    void put_error(std::span<const float> decoded, std::span<const float> truth);

    static constexpr float kErrorRange = 0.25F;  ///< light

    [[nodiscard]] const PngPixels& pixels() const { return pixels_; }

  private:
    [[nodiscard]] std::span<std::uint8_t> tile_row(Tile tile, int row);

    FrameShape frame_;
    PngPixels pixels_;
};

/// The slots, of `slots` from the first one on, that no exposure touches which an end of the clip
/// cuts: a running sensor would have those too. The sensor is reset at the beginning of slot
/// `phase_slots`. Nothing left: begin >= end.
[[nodiscard]] ComparedSlots whole_slots(const ExposureSchedule& schedule, std::int64_t phase_slots,
                                        int slots);

/// The slots of a clip that all points of a space compare: `space.compared`, else those that are
/// whole for all sensors of all points, without the usual margin; the margin alone if fewer than a
/// quarter of the slots were left. Points that cannot be set up have no say, systems that
/// Space::replace has left out do. \throws TrialStopped.
[[nodiscard]] ComparedSlots compared_slots(const Space& space, const TrialLight& light, int slots,
                                           const KeepGoing& keep_going);

}  // namespace stipple
