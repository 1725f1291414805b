#include "io/dng_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/error.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void fail_damaged(const std::string& where) {
    throw InputError(where, "has lossless JPEG data that is damaged");
}

/// Reads bits, the highest first; a byte 0 after 255 is left out, and other markers end the data.
class BitReader {
  public:
    BitReader(Bytes data, const std::string& where) : data_(data), where_(where) {}

    /// The next 16 bits, which stay; zeros behind the end.
    [[nodiscard]] std::uint32_t peek16() {
        while (count_ < 16) {
            bits_ = bits_ << 8U | next_byte();
            count_ += 8;
        }
        return bits_ >> static_cast<unsigned>(count_ - 16) & 0xFFFFU;
    }
    /// At most 16. \throws InputError if the data has ended before.
    void skip(int count) {
        count_ -= count;
        if (count_ < padding_) fail_damaged(where_);
    }

  private:
    std::uint32_t next_byte() {
        constexpr std::uint8_t kMark = 0xFF;
        const bool has_byte = at_ < data_.size();
        const bool is_marked = has_byte && data_[at_] == kMark;
        if (!has_byte || (is_marked && (at_ + 1 == data_.size() || data_[at_ + 1] != 0))) {
            padding_ += 8;
            return 0;
        }
        const std::uint8_t byte = data_[at_];
        at_ += is_marked ? 2 : 1;
        return byte;
    }

    Bytes data_;
    const std::string& where_;
    std::size_t at_ = 0;
    std::uint32_t bits_ = 0;
    int count_ = 0;
    int padding_ = 0;  ///< bits of the last ones that are none of the data
};

/// The category of differences by the next 16 bits (T.81, annex C).
class HuffmanTable {
  public:
    /// Of a segment from the numbers of codes on; takes it off.
    HuffmanTable(Bytes& segment, const std::string& where) {
        constexpr std::size_t kLengths = 16;
        constexpr std::uint8_t kMaxCategory = 16;
        if (segment.size() < kLengths) fail_damaged(where);
        const Bytes counts = segment.first(kLengths);
        Bytes values = segment.subspan(kLengths);
        std::size_t next = 0;
        for (std::size_t length = 1; length <= kLengths; ++length)
            for (int i = 0; i < counts[length - 1]; ++i) {
                const std::size_t covered = std::size_t{1} << (kLengths - length);
                if (values.empty() || values[0] > kMaxCategory || covered > codes_.size() - next)
                    fail_damaged(where);
                for (std::size_t end = next + covered; next < end; ++next)
                    codes_[next] = {static_cast<std::uint8_t>(length), values[0]};
                values = values.subspan(1);
            }
        segment = values;
    }

    /// The next difference from the prediction. \throws InputError at `where`.
    [[nodiscard]] std::uint32_t difference(BitReader& bits, const std::string& where) const {
        constexpr int kHalf = 16;  // a difference of 32768, without further bits
        const Code code = codes_[bits.peek16()];
        if (code.length == 0) fail_damaged(where);
        bits.skip(code.length);
        if (code.category == 0) return 0;
        if (code.category == kHalf) return 32768;
        const std::uint32_t value = bits.peek16() >> (16U - code.category);
        bits.skip(code.category);
        const std::uint32_t half = 1U << (code.category - 1U);
        return value < half ? value - (2 * half - 1) : value;  // modulo 2^32
    }

  private:
    struct Code {
        std::uint8_t length = 0;
        std::uint8_t category = 0;
    };
    std::vector<Code> codes_ = std::vector<Code>(65536);
};

/// A JPEG file of one scan.
class Decoder {
  public:
    Decoder(Bytes jpeg, const std::string& where) : rest_(jpeg), where_(where) {}

    void decode(std::span<std::uint16_t> samples);

  private:
    static constexpr std::uint8_t kStartOfScan = 0xDA;

    /// The kind of the next segment, which is in `segment_` afterwards.
    std::uint8_t next_segment();
    void read_frame();
    void read_tables();
    void read_scan();
    void decode_data(std::span<std::uint16_t> samples);
    [[nodiscard]] std::uint32_t predicted(std::span<const std::uint16_t> samples,
                                          std::size_t at) const;

    Bytes rest_;
    const std::string& where_;
    Bytes segment_;
    int precision_ = 0;
    std::size_t rows_ = 0;
    std::size_t row_samples_ = 0;  ///< of all components
    std::vector<std::uint8_t> components_;
    std::array<std::vector<HuffmanTable>, 4> tables_;  ///< each empty or one
    std::vector<const HuffmanTable*> used_;            ///< of each component
    int predictor_ = 0;
    unsigned shift_ = 0;
};

std::uint8_t Decoder::next_segment() {
    if (rest_.size() < 4 || rest_[0] != 0xFF) fail_damaged(where_);
    const std::uint8_t kind = rest_[1];
    const std::size_t length = std::size_t{rest_[2]} << 8U | rest_[3];
    if (length < 2 || length > rest_.size() - 2) fail_damaged(where_);
    segment_ = rest_.subspan(4, length - 2);
    rest_ = rest_.subspan(2 + length);
    return kind;
}

void Decoder::read_frame() {
    if (segment_.size() < 6 || segment_.size() != std::size_t{6} + 3 * segment_[5])
        fail_damaged(where_);
    precision_ = segment_[0];
    rows_ = std::size_t{segment_[1]} << 8U | segment_[2];
    const std::size_t cols = std::size_t{segment_[3]} << 8U | segment_[4];
    const std::size_t count = segment_[5];
    row_samples_ = cols * count;
    if (precision_ < 2 || precision_ > 16 || count < 1 || count > 4 || row_samples_ == 0)
        fail_damaged(where_);
    components_.clear();
    for (std::size_t i = 0; i < count; ++i) {
        components_.push_back(segment_[6 + 3 * i]);
        constexpr std::uint8_t kWhole = 0x11;
        if (segment_[7 + 3 * i] != kWhole)
            throw InputError(where_, "has lossless JPEG data of subsampled components");
    }
}

void Decoder::read_tables() {
    while (!segment_.empty()) {
        const std::uint8_t number = segment_[0];
        if (number >= tables_.size()) fail_damaged(where_);
        segment_ = segment_.subspan(1);
        tables_[number].assign(1, HuffmanTable(segment_, where_));
    }
}

void Decoder::read_scan() {
    const std::size_t count = components_.size();
    if (count == 0 || segment_.size() != 4 + 2 * count || segment_[0] != count)
        fail_damaged(where_);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t table = segment_[2 + 2 * i] >> 4U;
        if (segment_[1 + 2 * i] != components_[i] || table >= tables_.size() ||
            tables_[table].empty())
            fail_damaged(where_);
        used_.push_back(&tables_[table].front());
    }
    predictor_ = segment_[1 + 2 * count];
    shift_ = segment_[3 + 2 * count] & 0x0FU;
    if (predictor_ < 1 || predictor_ > 7 || static_cast<int>(shift_) >= precision_)
        fail_damaged(where_);
}

/// Of T.81, table H.1; in the first row the sample to the left, and in the first column that above.
std::uint32_t Decoder::predicted(std::span<const std::uint16_t> samples, std::size_t at) const {
    const std::size_t count = used_.size();
    const std::size_t col = at % row_samples_;
    if (at < count) return 1U << (static_cast<unsigned>(precision_) - shift_ - 1U);
    if (at < row_samples_) return samples[at - count];
    const std::int32_t above = samples[at - row_samples_];
    if (col < count) return static_cast<std::uint32_t>(above);
    const std::int32_t left = samples[at - count];
    const std::int32_t corner = samples[at - row_samples_ - count];
    const auto value = [&] {
        switch (predictor_) {
            case 1:
                return left;
            case 2:
                return above;
            case 3:
                return corner;
            case 4:
                return left + above - corner;
            case 5:
                return left + ((above - corner) >> 1);
            case 6:
                return above + ((left - corner) >> 1);
            default:
                return (left + above) >> 1;
        }
    };
    return static_cast<std::uint32_t>(value());
}

void Decoder::decode_data(std::span<std::uint16_t> samples) {
    BitReader bits(rest_, where_);
    for (std::size_t at = 0; at < samples.size(); ++at) {
        const std::uint32_t difference = used_[at % used_.size()]->difference(bits, where_);
        samples[at] = static_cast<std::uint16_t>(predicted(samples, at) + difference);
    }
    if (shift_ > 0)
        for (std::uint16_t& sample : samples) sample = static_cast<std::uint16_t>(sample << shift_);
}

void Decoder::decode(std::span<std::uint16_t> samples) {
    constexpr std::uint8_t kStartOfImage = 0xD8;
    constexpr std::uint8_t kLosslessFrame = 0xC3;
    constexpr std::uint8_t kTables = 0xC4;
    constexpr std::uint8_t kRestartInterval = 0xDD;
    if (rest_.size() < 2 || rest_[0] != 0xFF || rest_[1] != kStartOfImage) fail_damaged(where_);
    rest_ = rest_.subspan(2);
    for (std::uint8_t kind = next_segment(); kind != kStartOfScan; kind = next_segment()) {
        const bool is_frame = kind >= 0xC0 && kind <= 0xCF && kind != 0xC8 && kind != 0xCC;
        if (kind == kTables)
            read_tables();
        else if (kind == kLosslessFrame)
            read_frame();
        else if (is_frame)
            throw InputError(where_, "has JPEG data that is not lossless");
        else if (kind == kRestartInterval && std::ranges::any_of(segment_, std::identity()))
            throw InputError(where_, "has lossless JPEG data with restart intervals");
    }
    read_scan();
    if (rows_ * row_samples_ != samples.size())
        throw InputError(where_, fmt::format("has lossless JPEG data of {} samples in place of {}; "
                                             "it is damaged",
                                             rows_ * row_samples_, samples.size()));
    decode_data(samples);
}

}  // namespace

void decode_lossless_jpeg(Bytes jpeg, const std::string& where, std::span<std::uint16_t> samples) {
    Decoder(jpeg, where).decode(samples);
}

}  // namespace stipple
