#include "io/pixel_format.h"

#include <algorithm>
#include <cstddef>

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Samples = std::span<std::uint16_t>;

std::uint16_t narrow(unsigned value) {
    return static_cast<std::uint16_t>(value);
}

void unpack_bytes(Bytes row, Samples samples) {
    std::copy_n(row.begin(), samples.size(), samples.begin());
}

template <std::size_t kLow>
void unpack_words(Bytes row, Samples samples) {
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = narrow(static_cast<unsigned>(row[2 * i + kLow] | row[2 * i + 1 - kLow] << 8));
}

/// A bit string, bit k being bit k % 8 of byte k / 8: sample i is bits i * bits and up.
void unpack_bit_string(Bytes row, unsigned bits, Samples samples) {
    std::uint32_t pending = 0;
    unsigned have = 0;
    std::size_t at = 0;
    const std::uint32_t mask = (1U << bits) - 1;
    for (std::uint16_t& sample : samples) {
        for (; have < bits; have += 8) pending |= std::uint32_t{row[at++]} << have;
        sample = narrow(pending & mask);
        pending >>= bits;
        have -= bits;
    }
}

/// 12 bits a sample are 2 samples in 3 bytes.
void unpack_12_bit_string(Bytes row, Samples samples) {
    const std::size_t pairs = samples.size() / 2;
    for (std::size_t i = 0; i < pairs; ++i) {
        const std::uint8_t* const three = &row[3 * i];
        samples[2 * i] = narrow(three[0] | (three[1] & 0xFU) << 8U);
        samples[2 * i + 1] = narrow(three[1] >> 4U | unsigned{three[2]} << 4U);
    }
    unpack_bit_string(row.subspan(3 * pairs), 12, samples.subspan(2 * pairs));
}

/// A bit string, bit k being bit 7 - k % 8 of byte k / 8: sample i is bits i * bits and up.
void unpack_msb_string(Bytes row, unsigned bits, Samples samples) {
    std::uint32_t pending = 0;
    unsigned have = 0;
    std::size_t at = 0;
    const std::uint32_t mask = (1U << bits) - 1;
    for (std::uint16_t& sample : samples) {
        for (; have < bits; have += 8) pending = pending << 8U | row[at++];
        have -= bits;
        sample = narrow(pending >> have & mask);
    }
}

/// Two samples in 3 bytes, the low bits of both in the middle one: from bit 0 and from bit 4.
void unpack_gige_vision(Bytes row, unsigned bits, Samples samples) {
    const unsigned low_bits = bits - 8;
    const unsigned low_mask = (1U << low_bits) - 1;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t group = i / 2 * 3;
        const bool second = i % 2 == 1;
        const unsigned high = row[second ? group + 2 : group];
        const unsigned low = unsigned{row[group + 1]} >> (second ? 4U : 0U) & low_mask;
        samples[i] = narrow(high << low_bits | low);
    }
}

/// Groups whose low bits fill whole bytes: first the high 8 bits of each sample, then the low bits
/// as a bit string. The last group of a row may be short of samples, not of high bytes.
void unpack_mipi(Bytes row, unsigned bits, Samples samples) {
    const unsigned low_bits = bits - 8;
    const std::size_t group = bits == 12 ? 2 : 4;
    const std::size_t group_bytes = group * bits / 8;
    for (std::size_t first = 0; first < samples.size(); first += group) {
        const std::size_t count = std::min(group, samples.size() - first);
        const Bytes bytes = row.subspan(first / group * group_bytes);
        const Samples part = samples.subspan(first, count);
        unpack_bit_string(bytes.subspan(std::min(group, bytes.size())), low_bits, part);
        for (std::size_t i = 0; i < count; ++i)
            part[i] = narrow(unsigned{bytes[i]} << low_bits | part[i]);
    }
}

}  // namespace

std::vector<float> light_table(const PixelFormat& format, double black_dn, double white_dn) {
    // Devices may set bits that should be 0: a table for all that 16 bits hold.
    std::vector<float> light(format.significant_bits == 8 ? 256 : 65536);
    for (std::size_t dn = 0; dn < light.size(); ++dn)
        light[dn] = static_cast<float>(std::max(0.0, static_cast<double>(dn) - black_dn) /
                                       (white_dn - black_dn));
    return light;
}

void unpack_row(const PixelFormat& format, Bytes row, Samples samples) noexcept {
    const auto bits = static_cast<unsigned>(format.significant_bits);
    switch (format.packing) {
        case Packing::kBytes:
            return bits == 8 ? unpack_bytes(row, samples) : unpack_words<0>(row, samples);
        case Packing::kBytesBigEndian:
            return unpack_words<1>(row, samples);
        case Packing::kLsbPacked:
            return bits == 12 ? unpack_12_bit_string(row, samples)
                              : unpack_bit_string(row, bits, samples);
        case Packing::kMsbPacked:
            return unpack_msb_string(row, bits, samples);
        case Packing::kGigEVisionPacked:
            return unpack_gige_vision(row, bits, samples);
        case Packing::kMipiPacked:
            return unpack_mipi(row, bits, samples);
    }
}

}  // namespace stipple
