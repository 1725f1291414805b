// The SIMD forms of the samplers: compiled once per target by foreach_target.h, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sensor_model/noise_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <cassert>
#include <cstddef>

#include "sensor_model/normal-inl.h"
#include "sensor_model/normal.h"
#include "sensor_model/philox-inl.h"
#include "sensor_model/poisson-inl.h"
#include "sensor_model/poisson.h"
#include "sensor_model/sample_words.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Each kernel works on whole vectors and returns how many elements it did; its caller does the
// rest with the scalar form, which is the same bits.
#if HWY_TARGET == HWY_SCALAR

std::size_t normal_vectors(std::span<const std::uint32_t>, float*) {
    return 0;
}
std::size_t poisson_vectors(std::span<const float>, const std::uint32_t*, std::uint32_t*) {
    return 0;
}
std::size_t sample_word_vectors(std::span<const std::uint32_t>, const SampleAddress&,
                                std::uint32_t*, std::uint32_t*) {
    return 0;
}

#else

std::size_t normal_vectors(std::span<const std::uint32_t> word, float* value) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= word.size(); i += hn::Lanes(d))
        hn::StoreU(normal(d, hn::LoadU(du, &word[i])), d, value + i);
    return i;
}

std::size_t poisson_vectors(std::span<const float> mean, const std::uint32_t* word,
                            std::uint32_t* count) {
    const hn::ScalableTag<float> d;
    const hn::RebindToUnsigned<decltype(d)> du;
    std::size_t i = 0;
    for (; i + hn::Lanes(d) <= mean.size(); i += hn::Lanes(d)) {
        const auto k = poisson(d, hn::LoadU(d, &mean[i]), hn::LoadU(du, word + i));
        hn::StoreU(hn::BitCast(du, k), du, count + i);
    }
    return i;
}

std::size_t sample_word_vectors(std::span<const std::uint32_t> pixel, const SampleAddress& address,
                                std::uint32_t* shot, std::uint32_t* read) {
    const hn::ScalableTag<std::uint32_t> du;
    std::size_t i = 0;
    for (; i + hn::Lanes(du) <= pixel.size(); i += hn::Lanes(du)) {
        hn::Vec<decltype(du)> shot_words, read_words;
        sample_words(du, hn::LoadU(du, &pixel[i]), address, shot_words, read_words);
        hn::StoreU(shot_words, du, shot + i);
        hn::StoreU(read_words, du, read + i);
    }
    return i;
}

#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(normal_vectors);
HWY_EXPORT(poisson_vectors);
HWY_EXPORT(sample_word_vectors);

void normal(std::span<const std::uint32_t> word, std::span<float> value) noexcept {
    assert(word.size() == value.size());
    std::size_t i = HWY_DYNAMIC_DISPATCH(normal_vectors)(word, value.data());
    for (; i < word.size(); ++i) value[i] = normal_one(word[i]);
}

void poisson(std::span<const float> mean, std::span<const std::uint32_t> word,
             std::span<std::uint32_t> count) noexcept {
    assert(mean.size() == word.size() && mean.size() == count.size());
    std::size_t i = HWY_DYNAMIC_DISPATCH(poisson_vectors)(mean, word.data(), count.data());
    for (; i < mean.size(); ++i) count[i] = poisson_one(mean[i], word[i]);
}

void sample_words(std::span<const std::uint32_t> pixel, const SampleAddress& address,
                  std::span<std::uint32_t> shot, std::span<std::uint32_t> read) noexcept {
    assert(pixel.size() == shot.size() && pixel.size() == read.size());
    std::size_t i =
        HWY_DYNAMIC_DISPATCH(sample_word_vectors)(pixel, address, shot.data(), read.data());
    for (; i < pixel.size(); ++i) {
        const PhiloxCounter block = philox4x32(
            random_address(pixel[i], address.slot, RandomPurpose::kSample, address.plane),
            address.seed);
        shot[i] = block[0];
        read[i] = block[1];
    }
}

}  // namespace stipple
#endif  // HWY_ONCE
