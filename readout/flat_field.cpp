#include "readout/flat_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "readout/coded_sensor.h"

namespace stipple {
namespace {

SensorParams checked(SensorParams params) {
    if (!params.physical.transmittance.empty() || !params.physical.gain_map.empty())
        throw InputError(fmt::format("sensor \"{}\"", params.name),
                         "has pixels of unequal transmittance or gain, which EMVA 1288 does not "
                         "know; set transmittance=[] and gain_map=[]");
    params.physical.cfa = ColourFilter::kNone;
    return params;
}

}  // namespace

std::vector<FlatFieldExposure> flat_field_exposures(const SensorParams& params) {
    constexpr int kPairs = 50;
    constexpr int kStack = 100;
    constexpr double kMaxSaturation = 1.15;
    const double saturation = params.saturation_e() / params.physical.quantum_efficiency;
    std::vector<FlatFieldExposure> exposures{{.photons = 0, .images = 2}};
    for (int i = 1; i <= kPairs; ++i)
        exposures.push_back({.photons = kMaxSaturation * saturation * i / kPairs, .images = 2});
    exposures.push_back({.photons = saturation / 2, .images = kStack});
    exposures.push_back({.photons = 0, .images = kStack});
    return exposures;
}

std::vector<CalibrationExposure> calibration_exposures(const SensorParams& params,
                                                       const CalibrationImages& images,
                                                       std::uint64_t seed) {
    constexpr int kLongSlots = 16;
    constexpr std::uint64_t kSeeds = 0x9E3779B97F4A7C15;  // no seed that somebody chooses
    constexpr double kBrightest = 0.9;
    const double saturation = params.saturation_e() / params.physical.quantum_efficiency;
    std::vector<CalibrationExposure> exposures{
        {.slot_us = params.slot_us, .images = images.darks, .seed = seed + kSeeds},
        {.slot_us = params.slot_us * kLongSlots, .images = images.darks, .seed = seed + 2 * kSeeds},
        {.slot_us = params.slot_us,
         .photons = saturation / 2,
         .images = images.flats,
         .seed = seed + 3 * kSeeds}};
    for (int level = 1; level <= images.levels; ++level) {
        const double saturations = kBrightest * level / images.levels;
        exposures.push_back({.slot_us = params.slot_us * saturations * 2,
                             .photons = saturation * saturations,
                             .images = std::max(images.flats / 10, 8),
                             .seed = seed + static_cast<std::uint64_t>(3 + level) * kSeeds});
    }
    return exposures;
}

struct FlatField::Impl {
    Impl(SensorParams given, std::uint64_t seed, FrameShape shape)
        : cfa(given.physical.cfa),
          params(checked(std::move(given))),
          header{.shape = shape,
                 .slot_us = params.slot_us,
                 .calibration = calibration_of(params),
                 .schedule = {1, 1, 1, {0, 1}, {{.first_slot = 0, .open_slots = 1}}},
                 .schedule_source = {},
                 .schedule_name = "every slot",
                 .provenance = "",
                 .cfa = cfa},
          sensor(params, shape, header.schedule, seed),
          light(shape.sites()) {}

    ColourFilter cfa;
    SensorParams params;
    StreamHeader header;
    CodedSensor sensor;
    std::vector<float> light;
    SamplePacket packet;
};

FlatField::FlatField(SensorParams params, std::uint64_t seed, FrameShape shape)
    : impl_(std::make_unique<Impl>(std::move(params), seed, shape)) {}

FlatField::~FlatField() = default;

const StreamHeader& FlatField::header() const {
    return impl_->header;
}

const SamplePacket& FlatField::expose(double photons) {
    std::ranges::fill(impl_->light, static_cast<float>(photons / impl_->params.photons_per_unit));
    impl_->sensor.expose(impl_->light, impl_->packet);
    return impl_->packet;
}

const std::vector<std::uint16_t>& FlatField::capture(double photons) {
    return expose(photons).dn;
}

}  // namespace stipple
