#include "study/report/report_page.h"

#include <openssl/evp.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace stipple {
namespace {

/// Differences with their sign in the lowest bit; low bytes, then high bytes.
std::vector<unsigned char> difference_bytes(std::span<const std::uint16_t> values,
                                            std::size_t step) {
    const std::size_t count = values.size();
    std::vector<unsigned char> bytes(2 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const int before = i < step ? 0 : values[i - step];
        const auto difference = static_cast<std::int16_t>(values[i] - before);
        const auto folded = static_cast<unsigned>(2 * difference ^ (difference < 0 ? -1 : 0));
        bytes[i] = static_cast<unsigned char>(folded & 0xffU);
        bytes[count + i] = static_cast<unsigned char>(folded >> 8U & 0xffU);
    }
    return bytes;
}

std::vector<unsigned char> deflated(const std::vector<unsigned char>& bytes) {
    uLongf length = compressBound(static_cast<uLong>(bytes.size()));
    std::vector<unsigned char> packed(length);
    // It fails for want of memory only: the bound is large enough.
    if (compress(packed.data(), &length, bytes.data(), static_cast<uLong>(bytes.size())) != Z_OK)
        throw std::bad_alloc();
    packed.resize(length);
    return packed;
}

}  // namespace

std::uint16_t light_code(float light) noexcept {
    constexpr auto kDarkest = static_cast<float>(kDarkestCodedLight);
    if (!(light >= kDarkest)) return 0;
    const float stops = std::log2(light) - std::log2(kDarkest);  // a quotient might overflow
    const float steps = stops * static_cast<float>(kCodesPerStop);
    return static_cast<std::uint16_t>(1 + std::lround(std::min(steps, 65534.0F)));
}

std::vector<std::uint16_t> light_codes(std::span<const float> light) {
    std::vector<std::uint16_t> codes(light.size());
    std::ranges::transform(light, codes.begin(), light_code);
    return codes;
}

double light_of_code(std::uint16_t code) noexcept {
    return code == 0 ? 0 : kDarkestCodedLight * std::exp2((code - 1) / double{kCodesPerStop});
}

std::string packed_plane(std::span<const std::uint16_t> values, std::size_t step) {
    const auto bytes = deflated(difference_bytes(values, step));
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // EVP_EncodeBlock ends it with a zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                    static_cast<int>(bytes.size()));
    text.pop_back();
    return text;
}

}  // namespace stipple
