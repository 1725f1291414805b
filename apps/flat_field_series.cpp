#include "apps/flat_field_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "apps/report/text_file.h"
#include "core/error.h"
#include "io/dn_image.h"
#include "readout/coded_sensor.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 240, .cols = 320, .planes = 1};
constexpr int kPairs = 50;
constexpr int kStack = 100;
constexpr double kMaxSaturation = 1.15;

/// Photons that fill the well or the converter of a mean pixel.
double saturation_photons(const SensorParams& params) {
    const double quantum_efficiency = params.physical.quantum_efficiency;
    return configured_figures(params).saturation_e / quantum_efficiency;
}

/// The sensor in front of the lamp.
class Bench {
  public:
    Bench(const SensorParams& params, std::uint64_t seed, const std::filesystem::path& folder,
          const std::function<void()>& advance)
        : params_(params),
          sensor_(params, kShape, every_slot_, seed),
          folder_(folder),
          advance_(advance),
          frame_(kShape.pixels()) {
        series_ = {
            .bits = params.bit_depth, .cols = kShape.cols, .rows = kShape.rows, .groups = {}};
    }

    void photograph(double photons, int images) {
        emva1288::ImageGroup group{.exposure_ns = params_.slot_us * 1000,
                                   .photons = photons,
                                   .dark = photons == 0,
                                   .files = {}};
        std::ranges::fill(frame_, static_cast<float>(photons / params_.photons_per_unit));
        for (int i = 0; i < images; ++i) {
            sensor_.expose(frame_, packet_);
            group.files.push_back(fmt::format("image_{:04}.png", ++images_));
            write_dn_png(folder_ / group.files.back(), kShape, packet_.dn);
            advance_();
        }
        series_.groups.push_back(std::move(group));
    }

    [[nodiscard]] const emva1288::Series& series() const { return series_; }

  private:
    const SensorParams& params_;
    ExposureSchedule every_slot_{1, 1, 1, {0, 1}, {{.first_slot = 0, .open_slots = 1}}};
    CodedSensor sensor_;
    const std::filesystem::path& folder_;
    const std::function<void()>& advance_;
    std::vector<float> frame_;
    SamplePacket packet_;
    emva1288::Series series_;
    int images_ = 0;
};

}  // namespace

bool is_series_image_name(std::string_view name) {
    int image = 0;
    const auto [end, error] = std::from_chars(name.data() + std::min<std::size_t>(name.size(), 6),
                                              name.data() + name.size(), image);
    return error == std::errc() && name == fmt::format("image_{:04}.png", image);
}

void capture_flat_fields(const SensorParams& params, std::uint64_t seed,
                         const std::filesystem::path& folder,
                         const std::function<void()>& advance) {
    if (!params.physical.transmittance.empty() || !params.physical.gain_map.empty())
        throw InputError(fmt::format("sensor \"{}\"", params.name),
                         "has pixels of unequal transmittance or gain, which EMVA 1288 does not "
                         "know; set transmittance=[] and gain_map=[]");
    Bench bench(params, seed, folder, advance);
    const double saturation = saturation_photons(params);
    bench.photograph(0, 2);
    for (int i = 1; i <= kPairs; ++i) bench.photograph(kMaxSaturation * saturation * i / kPairs, 2);
    bench.photograph(saturation / 2, kStack);
    bench.photograph(0, kStack);
    const std::string text = series_text(bench.series());
    const auto descriptor = folder / kDescriptorName;
    write_whole(descriptor, descriptor.string(), text);
}

}  // namespace stipple
