#include "readout/coded_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "readout/column_adc.h"
#include "readout/schedule_feasibility.h"
#include "readout/sequencer.h"
#include "sensor_model/physical_pixels.h"
#include "sensor_model/pixel_array.h"
#include "sensor_model/slot_light.h"

namespace stipple {
namespace {

constexpr int kBandRows = 16;  ///< rows that one thread takes at a time: a few hundred kilobytes

void check(FrameShape shape) {
    if (shape.rows < 1 || shape.cols < 1 || shape.planes < 1 || shape.pixels() > UINT32_MAX)
        throw InputError("sensor", fmt::format("array of {} x {} pixels and {} planes: needs 1 to "
                                               "2^32 - 1 pixels and at least one plane",
                                               shape.rows, shape.cols, shape.planes));
}

/// The schedule, if pixels of this sensor can do what it says.
const ExposureSchedule& checked(const ExposureSchedule& schedule, const SensorParams& params) {
    if (const auto problem = store_problem(schedule, params.charge_stores))
        throw InputError("exposure schedule", *problem);
    return schedule;
}

/// The samples of a band of rows and what leads to them; kept so that no slot allocates.
struct Band {
    std::vector<std::uint32_t> pixels;      ///< due, in scan order
    std::vector<std::uint8_t> stores;       ///< of each, if there are two charge stores
    std::vector<std::uint16_t> dn;          ///< planes of a pixel side by side
    std::vector<std::uint16_t> open_slots;  ///< of each due pixel, in physical mode
    std::uint64_t saturated = 0;
    std::uint64_t zeros = 0;
    std::vector<std::uint8_t> open;  ///< of one row
    std::vector<float> light;        ///< of one plane, as the next three
    std::vector<float> electrons;
    std::vector<std::uint8_t> clipped;  ///< by the full well
    std::vector<std::uint16_t> plane_dn;
};

void add(std::span<const float> frame, std::span<float> light) noexcept {
    for (std::size_t i = 0; i < light.size(); ++i) light[i] += frame[i];
}

/// Adds to charge store 1 or 2 where it is the one that is open, and the fraction `parasitic` where
/// it is not.
void add_where(std::span<const std::uint8_t> open, int store, float parasitic,
               std::span<const float> frame, std::span<float> light) noexcept {
    if (parasitic == 0) {
        for (std::size_t i = 0; i < light.size(); ++i)
            light[i] += open[i] == store ? frame[i] : 0.0F;
        return;
    }
    for (std::size_t i = 0; i < light.size(); ++i)
        light[i] += open[i] == store ? frame[i] : parasitic * frame[i];
}

/// Moves the light of `pixels` out of `plane`, which leaves them reset.
void take(std::span<const std::uint32_t> pixels, std::span<float> plane,
          std::span<float> light) noexcept {
    for (std::size_t i = 0; i < pixels.size(); ++i)
        light[i] = std::exchange(plane[pixels[i]], 0.0F);
}

/// The same of each pixel's store, 0 or 1; the second is `apart` values after the first.
void take(const Band& band, std::size_t apart, std::span<float> plane,
          std::span<float> light) noexcept {
    for (std::size_t i = 0; i < band.pixels.size(); ++i)
        light[i] = std::exchange(plane[band.pixels[i] + band.stores[i] * apart], 0.0F);
}

/// The maps as a calibration tile; none if there are none.
CalibrationTile tile_of(const PhysicalTerms& terms) {
    if (terms.transmittance.empty() && terms.gain_map.empty()) return {};
    const auto pixels =
        static_cast<std::size_t>(terms.map_rows) * static_cast<std::size_t>(terms.map_cols);
    CalibrationTile tile{terms.map_rows, terms.map_cols, std::vector<CalibrationPixel>(pixels)};
    for (std::size_t i = 0; i < terms.transmittance.size(); ++i)
        tile.pixels[i].responsivity = terms.transmittance[i];
    for (std::size_t i = 0; i < terms.gain_map.size(); ++i)
        tile.pixels[i].conversion_gain = terms.gain_map[i];
    return tile;
}

}  // namespace

Calibration calibration_of(const SensorParams& params) {
    return {.bit_depth = params.bit_depth,
            .rounding = params.rounding,
            .black_level_dn = params.physical.black_level_dn +
                              params.storage_dark_e() / 2 / params.gain_e_per_dn(),
            .gain_e_per_dn = params.gain_e_per_dn(),
            .read_noise_e = params.temporal_read_noise_e(),
            .full_well_e = params.full_well_e,
            .electrons_per_unit = params.electrons_per_unit(),
            .dark_e_per_slot = params.dark_e_per_slot(),
            .tile = tile_of(params.physical)};
}

struct CodedSensor::Impl {
    Impl(const SensorParams& params, FrameShape frame_shape, const ExposureSchedule& schedule,
         std::uint64_t noise_seed)
        : array(params, noise_seed),
          adc(params),
          sequencer(checked(schedule, params), frame_shape),
          shape(frame_shape),
          seed(noise_seed),
          stores(schedule.charge_stores()) {
        check(shape);
        light.resize(shape.sites() * static_cast<std::size_t>(stores));
        if (params.mode == SensorMode::kPhysical) set_up_physical(params, schedule);
        bands.resize(static_cast<std::size_t>((shape.rows + kBandRows - 1) / kBandRows));
    }

    void set_up_physical(const SensorParams& params, const ExposureSchedule& schedule);
    void switch_to(const SensorParams& params, const ExposureSchedule& schedule);
    [[nodiscard]] std::span<const float> light_of_slot(std::span<const float> frame);
    void find_overflow(std::span<const float> arriving, int row, Band& band);
    void store_lag(std::uint32_t plane, Band& band);
    void collect_band(std::span<const float> frame, int first_row, Band& band);
    void take_due(std::uint32_t plane, Band& band);
    void read_band(Band& band);
    void collect(std::span<const float> frame, int row, Band& band);
    void read(std::uint32_t plane, Band& band);

    void charge(std::uint32_t plane, Band& band) const;

    PixelArray array;
    std::optional<PhysicalPixels> physical;  ///< in place of `array` in physical mode
    std::optional<SlotLight> slot_light;     ///< where terms change the light of a slot
    std::vector<float> overflow;             ///< of this slot, for blooming; else empty
    float lag = 0;
    float parasitic = 0;  ///< fraction of light that a closed store collects
    ColumnAdc adc;
    Sequencer sequencer;
    FrameShape shape;
    std::uint64_t seed;
    int stores;                ///< charge stores that the schedule uses, 1 or 2
    std::vector<float> light;  ///< collected since the exposure began, (store, plane, row, col)
    std::vector<Band> bands;
    ReadoutStats stats;  ///< `stats.slots` is the slot to expose next
};

void CodedSensor::Impl::set_up_physical(const SensorParams& params,
                                        const ExposureSchedule& schedule) {
    const PhysicalTerms& terms = params.physical;
    physical.emplace(params, shape, seed);
    lag = static_cast<float>(terms.lag);
    // A single store that is always open is never closed, also not before its first exposure.
    if (stores == 2 || schedule.light_throughput() < 1)
        parasitic = static_cast<float>(terms.parasitic_light_sensitivity);
    if (SlotLight::changes(terms)) slot_light.emplace(terms, shape);
    if (terms.blooming != 0) overflow.resize(shape.sites());
}

void CodedSensor::Impl::switch_to(const SensorParams& params, const ExposureSchedule& schedule) {
    PixelArray next(params, seed);
    sequencer.switch_to(checked(schedule, params), stats.slots);
    array = next;
    adc = ColumnAdc(params);
    if (physical) physical.emplace(params, shape, seed);
    if (physical && schedule.light_throughput() < 1)
        parasitic = static_cast<float>(params.physical.parasitic_light_sensitivity);
}

/// The light of this slot that overflows in the pixels of one row: what comes when the well of the
/// open store is full.
void CodedSensor::Impl::find_overflow(std::span<const float> arriving, int row, Band& band) {
    const auto cols = static_cast<std::size_t>(shape.cols);
    band.open.resize(cols);
    sequencer.list_open(stats.slots, row, band.open);
    for (std::uint32_t plane = 0; plane < static_cast<std::uint32_t>(shape.planes); ++plane) {
        const std::size_t in_plane = static_cast<std::size_t>(row) * cols;
        const std::size_t first = plane * shape.pixels() + in_plane;
        for (std::size_t col = 0; col < cols; ++col) {
            const SiteParams& site = physical->pattern().plane(plane)[in_plane + col];
            const float incoming =
                std::min(arriving[first + col], std::numeric_limits<float>::max());
            const float held = light[first + col + (band.open[col] == 2 ? shape.sites() : 0)];
            const float excess = held + incoming - physical->full_well_light(site);
            const bool collects = band.open[col] != 0 && site.responsivity_e > 0;
            overflow[first + col] = collects ? std::clamp(excess, 0.0F, incoming) : 0;
        }
    }
}

/// The light that arrives in each pixel in this slot.
std::span<const float> CodedSensor::Impl::light_of_slot(std::span<const float> frame) {
    if (!slot_light) return frame;
    const auto arriving = slot_light->arriving(frame);
    if (overflow.empty()) return arriving;
    parallel_for(0, static_cast<int>(bands.size()), [&](int i) {
        const int end_row = std::min((i + 1) * kBandRows, shape.rows);
        for (int row = i * kBandRows; row < end_row; ++row)
            find_overflow(arriving, row, bands[static_cast<std::size_t>(i)]);
    });
    return slot_light->with_overflow(overflow);
}

/// Keeps a fraction of the charge of the due pixels for the next exposure of their stores.
void CodedSensor::Impl::store_lag(std::uint32_t plane, Band& band) {
    const auto at_plane = std::span(light).subspan(plane * shape.pixels());
    for (std::size_t i = 0; i < band.pixels.size(); ++i) {
        const SiteParams& site = physical->pattern().plane(plane)[band.pixels[i]];
        const float collected = std::min(band.light[i], std::numeric_limits<float>::max());
        const float residual = lag * std::min(collected, physical->full_well_light(site));
        band.light[i] = collected - residual;
        at_plane[band.pixels[i] + (stores == 2 ? band.stores[i] * shape.sites() : 0)] = residual;
    }
}

/// Adds the light of one row, all planes.
void CodedSensor::Impl::collect(std::span<const float> frame, int row, Band& band) {
    const bool all_open = stores == 1 && sequencer.all_open(stats.slots);
    const auto cols = static_cast<std::size_t>(shape.cols);
    if (!all_open) {
        band.open.resize(cols);
        sequencer.list_open(stats.slots, row, band.open);
    }
    for (auto at = static_cast<std::size_t>(row) * cols; at < frame.size(); at += shape.pixels()) {
        const auto from = frame.subspan(at, cols);
        const auto to = std::span(light).subspan(at, cols);
        all_open ? add(from, to) : add_where(band.open, 1, parasitic, from, to);
        if (stores == 2)
            add_where(band.open, 2, parasitic, from,
                      std::span(light).subspan(at + shape.sites(), cols));
    }
}

/// Light to electrons of the due pixels of one plane.
void CodedSensor::Impl::charge(std::uint32_t plane, Band& band) const {
    const auto slot = static_cast<std::uint32_t>(stats.slots);
    const Charges charges{band.electrons, band.clipped};
    if (physical)
        physical->expose({band.pixels, band.light, band.open_slots}, slot, plane, charges);
    else
        array.expose(band.light, band.pixels, slot, plane, charges);
}

/// The light of the due pixels of one plane, which are reset.
void CodedSensor::Impl::take_due(std::uint32_t plane, Band& band) {
    const auto at_plane = std::span(light).subspan(plane * shape.pixels());
    stores == 1 ? take(band.pixels, at_plane, band.light)
                : take(band, shape.sites(), at_plane, band.light);
    if (lag != 0) store_lag(plane, band);
}

/// Light to DN of the due pixels of one plane.
void CodedSensor::Impl::read(std::uint32_t plane, Band& band) {
    take_due(plane, band);                       // light since the exposure began, less the lag
    charge(plane, band);                         // photons, electrons, full well, read noise
    adc.convert(band.electrons, band.plane_dn);  // gain, black level, rounding, clipping

    const auto planes = static_cast<std::size_t>(shape.planes);
    for (std::size_t i = 0; i < band.pixels.size(); ++i) {
        band.dn[i * planes + plane] = band.plane_dn[i];
        if (band.clipped[i] != 0 || band.plane_dn[i] == adc.max_dn()) ++band.saturated;
    }
    band.zeros += static_cast<std::uint64_t>(std::ranges::count(band.plane_dn, 0));
}

/// The light of the slot, and the pixels that are due at its end.
void CodedSensor::Impl::collect_band(std::span<const float> frame, int first_row, Band& band) {
    const int end_row = std::min(first_row + kBandRows, shape.rows);
    band.pixels.clear();
    band.stores.clear();
    band.open_slots.clear();
    for (int row = first_row; row < end_row; ++row) {
        collect(frame, row, band);
        sequencer.append_due(stats.slots, row, band.pixels);
        if (stores == 2) sequencer.append_stores(stats.slots, row, band.stores);
        if (physical) sequencer.append_open_slots(stats.slots, row, band.open_slots);
    }
    band.light.resize(band.pixels.size());
}

void CodedSensor::Impl::read_band(Band& band) {
    const std::size_t samples = band.pixels.size();
    band.dn.resize(samples * static_cast<std::size_t>(shape.planes));
    band.electrons.resize(samples);
    band.clipped.resize(samples);
    band.plane_dn.resize(samples);
    band.saturated = 0;
    band.zeros = 0;
    for (int plane = 0; plane < shape.planes; ++plane)
        read(static_cast<std::uint32_t>(plane), band);
}

CodedSensor::CodedSensor(const SensorParams& params, FrameShape shape,
                         const ExposureSchedule& schedule, std::uint64_t seed,
                         std::int64_t first_slot)
    : impl_(std::make_unique<Impl>(params, shape, schedule, seed)) {
    impl_->stats.slots = first_slot;
}

CodedSensor::~CodedSensor() = default;
CodedSensor::CodedSensor(CodedSensor&&) noexcept = default;
CodedSensor& CodedSensor::operator=(CodedSensor&&) noexcept = default;

void CodedSensor::switch_to(const SensorParams& params, const ExposureSchedule& schedule) {
    impl_->switch_to(params, schedule);
}

void CodedSensor::expose(std::span<const float> frame, SamplePacket& packet) {
    assert(frame.size() == impl_->shape.sites());
    auto& bands = impl_->bands;
    const auto band_of = [&](int i) -> Band& { return bands[static_cast<std::size_t>(i)]; };

    // Crosstalk, blooming and skew change the light before it is collected.
    frame = impl_->light_of_slot(frame);

    // Each band of rows: light into the open stores; due pixels to electrons, then to DN; reset.
    parallel_for(0, static_cast<int>(bands.size()), [&](int i) {
        impl_->collect_band(frame, i * kBandRows, band_of(i));
        impl_->read_band(band_of(i));
    });

    // The samples in the order of rows, columns and planes.
    ReadoutStats& stats = impl_->stats;
    packet.slot = stats.slots++;
    packet.first_row = 0;
    packet.rows = impl_->shape.rows;
    packet.flags = 0;
    packet.dn.clear();
    for (const Band& band : bands) {
        packet.dn.insert(packet.dn.end(), band.dn.begin(), band.dn.end());
        stats.saturated_samples += band.saturated;
        stats.zero_samples += band.zeros;
    }
    stats.samples += packet.dn.size();
}

void CodedSensor::expose_unread(std::span<const float> frame) {
    assert(frame.size() == impl_->shape.sites());
    frame = impl_->light_of_slot(frame);
    parallel_for(0, static_cast<int>(impl_->bands.size()), [&](int i) {
        Band& band = impl_->bands[static_cast<std::size_t>(i)];
        impl_->collect_band(frame, i * kBandRows, band);
        for (int plane = 0; plane < impl_->shape.planes; ++plane)
            impl_->take_due(static_cast<std::uint32_t>(plane), band);
    });
    ++impl_->stats.slots;
}

const ReadoutStats& CodedSensor::stats() const {
    return impl_->stats;
}

}  // namespace stipple
