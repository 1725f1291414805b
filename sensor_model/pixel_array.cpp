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

void expose(const PixelLaw& law, const SampleAddress& address, std::span<const float> light,
            const std::uint32_t* pixel, float* electrons) {
    for (std::size_t i = 0; i < light.size(); ++i) {
        const PhiloxCounter block = philox4x32(
            random_address(pixel[i], address.slot, RandomPurpose::kSample, address.plane),
            address.seed);
        electrons[i] = expose_one(law, light[i], block[0], block[1]);
    }
}

#else

/// `expose_one` of a vector of samples.
template <class D, class V = hn::Vec<D>, class VU>
HWY_INLINE V expose_vector(D d, const PixelLaw& law, const SampleAddress& address, V light,
                           VU pixel) {
    const hn::RebindToUnsigned<D> du;
    VU shot_word, read_word;
    sample_words(du, pixel, address, shot_word, read_word);
    V charge = hn::Mul(hn::Set(d, law.electrons_per_unit), light);
    if (law.shot_noise) charge = hn::ConvertTo(d, poisson(d, charge, shot_word));
    charge = hn::Min(charge, hn::Set(d, law.full_well_e));
    return mul_then_add(normal(d, read_word), hn::Set(d, law.read_noise_e), charge);
}

void expose(const PixelLaw& law, const SampleAddress& address, std::span<const float> light,
            const std::uint32_t* pixel, float* electrons) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= light.size(); i += hn::Lanes(d))
        hn::StoreU(
            expose_vector(d, law, address, hn::LoadU(d, &light[i]), hn::LoadU(du, pixel + i)), d,
            electrons + i);
    if (i == light.size()) return;
    HWY_ALIGN float last_light[hn::MaxLanes(d)] = {};
    HWY_ALIGN std::uint32_t last_pixel[hn::MaxLanes(d)] = {};
    std::copy(light.begin() + static_cast<std::ptrdiff_t>(i), light.end(), last_light);
    std::copy(pixel + i, pixel + light.size(), last_pixel);
    const auto last =
        expose_vector(d, law, address, hn::Load(d, last_light), hn::Load(du, last_pixel));
    hn::Store(last, d, last_light);
    std::copy(last_light, last_light + (light.size() - i), electrons + i);
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {
namespace {

PixelLaw checked_law(const SensorParams& params) {
    validate(params);
    return {.electrons_per_unit = static_cast<float>(params.photons_per_unit),
            .full_well_e = static_cast<float>(params.full_well_e),
            .read_noise_e = static_cast<float>(params.read_noise_e),
            .shot_noise = params.shot_noise};
}

}  // namespace

HWY_EXPORT(expose);

float expose_one(const PixelLaw& law, float light, std::uint32_t shot_word,
                 std::uint32_t read_word) noexcept {
    float charge = law.electrons_per_unit * light;
    if (law.shot_noise) charge = static_cast<float>(poisson_one(charge, shot_word));
    return normal_one(read_word) * law.read_noise_e + std::min(charge, law.full_well_e);
}

PixelArray::PixelArray(const SensorParams& params, std::uint64_t seed)
    : law_(checked_law(params)), seed_(seed) {}

void PixelArray::expose(std::span<const float> light, std::span<const std::uint32_t> pixel,
                        std::uint32_t slot, std::uint32_t plane,
                        std::span<float> electrons) const noexcept {
    assert(light.size() == pixel.size() && light.size() == electrons.size());
    const SampleAddress address{.seed = seed_, .slot = slot, .plane = plane};
    HWY_DYNAMIC_DISPATCH(expose)(law_, address, light, pixel.data(), electrons.data());
}

}  // namespace stipple
#endif  // HWY_ONCE
