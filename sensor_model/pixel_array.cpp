#include "sensor_model/pixel_array.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sensor_model/pixel_array.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "sensor_model/normal-inl.h"
#include "sensor_model/normal.h"
#include "sensor_model/philox-inl.h"
#include "sensor_model/poisson-inl.h"
#include "sensor_model/poisson.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

void expose(const PixelModel& model, const SampleAddress& address, std::span<const float> light,
            const std::uint32_t* pixel, const Charges& charges) {
    for (std::size_t i = 0; i < light.size(); ++i) {
        const PhiloxCounter block = philox4x32(
            random_address(pixel[i], address.slot, RandomPurpose::kSample, address.plane),
            address.seed);
        const Charge charge = expose_one(model, light[i], block[0], block[1]);
        charges.electrons[i] = charge.electrons;
        if (!charges.clipped.empty()) charges.clipped[i] = charge.clipped ? 1 : 0;
    }
}

#else

/// The charges of a vector of samples.
template <class D>
struct ChargeVector {
    hn::Vec<D> electrons;
    hn::Mask<D> clipped;
};

/// `expose_one` of a vector of samples.
template <class D, class V = hn::Vec<D>, class VU>
HWY_INLINE ChargeVector<D> expose_vector(D d, const PixelModel& model, const SampleAddress& address,
                                         V light, VU pixel) {
    const hn::RebindToUnsigned<D> du;
    VU shot_word, read_word;
    sample_words(du, pixel, address, shot_word, read_word);
    V charge = hn::Mul(hn::Set(d, model.electrons_per_unit), light);
    if (model.shot_noise) charge = hn::ConvertTo(d, poisson(d, charge, shot_word));
    const V full_well = hn::Set(d, model.full_well_e);
    const V kept = hn::Min(charge, full_well);
    return {mul_then_add(normal(d, read_word), hn::Set(d, model.read_noise_e), kept),
            hn::Gt(charge, full_well)};
}

template <class D>
HWY_INLINE void store(D d, const ChargeVector<D>& from, float* electrons, std::uint8_t* clipped) {
    hn::StoreU(from.electrons, d, electrons);
    if (clipped == nullptr) return;
    const hn::RebindToSigned<D> di;
    const hn::Rebind<std::uint8_t, D> bytes;
    const auto ones = hn::IfThenElseZero(hn::RebindMask(di, from.clipped), hn::Set(di, 1));
    hn::StoreU(hn::DemoteTo(bytes, ones), bytes, clipped);
}

void expose(const PixelModel& model, const SampleAddress& address, std::span<const float> light,
            const std::uint32_t* pixel, const Charges& charges) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    std::size_t i = 0;
    std::uint8_t* const clipped = charges.clipped.empty() ? nullptr : charges.clipped.data();
    for (; i + hn::Lanes(d) <= light.size(); i += hn::Lanes(d))
        store(d,
              expose_vector(d, model, address, hn::LoadU(d, &light[i]), hn::LoadU(du, pixel + i)),
              &charges.electrons[i], clipped == nullptr ? nullptr : clipped + i);
    if (i == light.size()) return;
    HWY_ALIGN float last_light[hn::MaxLanes(d)] = {};
    HWY_ALIGN std::uint32_t last_pixel[hn::MaxLanes(d)] = {};
    std::uint8_t last_clipped[hn::MaxLanes(d)];
    std::copy(light.begin() + static_cast<std::ptrdiff_t>(i), light.end(), last_light);
    std::copy(pixel + i, pixel + light.size(), last_pixel);
    store(d, expose_vector(d, model, address, hn::Load(d, last_light), hn::Load(du, last_pixel)),
          last_light, last_clipped);
    const std::size_t rest = light.size() - i;
    std::copy_n(last_light, rest, &charges.electrons[i]);
    if (clipped != nullptr) std::copy_n(last_clipped, rest, clipped + i);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {
namespace {

PixelModel checked_model(const SensorParams& params) {
    validate(params);
    return {.electrons_per_unit = static_cast<float>(params.photons_per_unit),
            .full_well_e = static_cast<float>(params.full_well_e),
            .read_noise_e = static_cast<float>(params.read_noise_e),
            .shot_noise = params.shot_noise};
}

}  // namespace

HWY_EXPORT(expose);

Charge expose_one(const PixelModel& model, float light, std::uint32_t shot_word,
                  std::uint32_t read_word) noexcept {
    float charge = model.electrons_per_unit * light;
    if (model.shot_noise) charge = static_cast<float>(poisson_one(charge, shot_word));
    return {normal_one(read_word) * model.read_noise_e + std::min(charge, model.full_well_e),
            charge > model.full_well_e};
}

PixelArray::PixelArray(const SensorParams& params, std::uint64_t seed)
    : model_(checked_model(params)), seed_(seed) {}

void PixelArray::expose(std::span<const float> light, std::span<const std::uint32_t> pixel,
                        std::uint32_t slot, std::uint32_t plane,
                        const Charges& charges) const noexcept {
    assert(light.size() == pixel.size() && light.size() == charges.electrons.size());
    assert(charges.clipped.empty() || charges.clipped.size() == light.size());
    const SampleAddress address{.seed = seed_, .slot = slot, .plane = plane};
    HWY_DYNAMIC_DISPATCH(expose)(model_, address, light, pixel.data(), charges);
}

}  // namespace stipple
#endif  // HWY_ONCE
