#include "readout/program/program_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "stream/plain_text.h"
#include "stream/stream_header.h"

namespace stipple {
namespace {

constexpr std::string_view kTitle = "stipple sequencer program, version 1";
constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::size_t kMaxPixelSlots = std::size_t{1} << 28U;

std::size_t digits_per_word(const SequencerProgram& program) {
    return (index(program.tile_cols) * index(program.bits_per_pixel) + 3) / 4;
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

class Parser {
  public:
    Parser(std::string_view text, const std::string& where)
        : rest_(text), text_bytes_(text.size()), where_(where) {}

    NamedProgram parse() {
        std::string_view line;
        while (next_line(line)) {
            const auto comment = line.find("//");
            if (comment != std::string_view::npos) read_comment(trimmed(line.substr(comment + 2)));
            read_words(trimmed(line.substr(0, comment)));
        }
        if (pixels_.empty()) fail(fmt::format("holds no word; is it a \"{}\"?", kTitle));
        const auto missing = std::ranges::find(given_, false);
        if (missing != given_.end()) {
            const auto word = missing - given_.begin();
            fail(fmt::format("the word of slot {}, tile row {} (address {:x}) is missing",
                             word / value(kRows), word % value(kRows), word));
        }
        return {.name = name_, .program = program_with(std::move(pixels_))};
    }

  private:
    enum Field { kRows, kCols, kPeriod, kBits, kFields };
    struct FieldRule {
        std::string_view key;
        int max;
    };
    static constexpr std::array<FieldRule, kFields> kRules = {{{"tile_rows", kMaxTileSide},
                                                               {"tile_cols", kMaxTileSide},
                                                               {"period_slots", kMaxPeriodSlots},
                                                               {"bits_per_pixel", 3}}};

    [[noreturn]] void fail(const std::string& problem) const {
        throw InputError(fmt::format("{}:{}", where_, line_), problem);
    }
    [[nodiscard]] int value(Field field) const { return values_[field]; }

    bool next_line(std::string_view& line) {
        if (rest_.empty()) return false;
        const auto end = std::min(rest_.find('\n'), rest_.size());
        line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        ++line_;
        return true;
    }

    void read_comment(std::string_view comment) {
        if (comment == kTitle) is_ours_ = true;
        const auto equals = comment.find('=');
        if (!is_ours_ || !pixels_.empty() || equals == std::string_view::npos) return;
        const std::string_view key = trimmed(comment.substr(0, equals));
        const std::string_view text = trimmed(comment.substr(equals + 1));
        if (key == "name") {
            if (text.size() > kMaxNameBytes)
                fail(fmt::format("the name has more than {} bytes", kMaxNameBytes));
            if (!is_plain_text(text, false))
                fail("the name has control characters, or is not UTF-8");
            name_ = text;
        }
        for (std::size_t i = 0; i < kFields; ++i)
            if (key == kRules[i].key) values_[i] = number(text, kRules[i]);
    }

    [[nodiscard]] int number(std::string_view text, const FieldRule& rule) const {
        const auto result = parsed_number<int>(text);
        if (!result || *result < 1 || *result > rule.max)
            fail(fmt::format("{} = {}: needs an integer from 1 to {}", rule.key, text, rule.max));
        return *result;
    }

    void read_words(std::string_view line) {
        while (!line.empty()) {
            const auto end = std::min(line.find_first_of(" \t"), line.size());
            const std::string_view word = line.substr(0, end);
            line = trimmed(line.substr(end));
            if (word.front() == '@')
                read_address(word.substr(1));
            else
                read_word(word);
        }
    }

    void read_address(std::string_view text) {
        const auto address = parsed_number<std::size_t>(text, 16);
        if (!address) fail(fmt::format("\"@{}\" is not a hexadecimal address", text));
        address_ = *address;
    }

    /// Takes memory once the figures are known and the first word has their width.
    void begin() {
        if (!is_ours_) fail(fmt::format("there is no line \"// {}\" before the words", kTitle));
        for (std::size_t i = 0; i < kFields; ++i)
            if (values_[i] == 0)
                fail(fmt::format("there is no line \"// {} = ...\" before the words",
                                 kRules[i].key));
        const std::size_t words = index(value(kPeriod)) * index(value(kRows));
        if (words > kMaxPixelSlots / index(value(kCols)))
            fail("the tile and its period are larger than 2^28 pixels x slots");
        if (words > text_bytes_ / digits_per_word(program_with({})))
            fail(fmt::format("the file is too short for {} words", words));
        given_.assign(words, false);
        pixels_.resize(words * index(value(kCols)));
    }

    void read_word(std::string_view text) {
        if (pixels_.empty()) begin();
        const std::size_t digits = digits_per_word(program_with({}));
        if (text.size() != digits)
            fail(fmt::format("a word of {} digits; {} columns of {} bits take {}", text.size(),
                             value(kCols), value(kBits), digits));
        if (address_ >= given_.size())
            fail(fmt::format("address {:x} is beyond the last word, {:x}", address_,
                             given_.size() - 1));
        if (given_[address_]) fail(fmt::format("address {:x} comes twice", address_));
        given_[address_] = true;
        const std::size_t first = address_++ * index(value(kCols));
        const std::size_t bits_per_pixel = index(value(kBits));
        for (std::size_t digit = 0; digit < digits; ++digit) {
            const unsigned nibble = nibble_of(text[digits - 1 - digit]);
            for (std::size_t i = 0; i < 4; ++i) {
                if ((nibble >> i & 1U) == 0) continue;
                const std::size_t bit = 4 * digit + i;
                if (bit >= index(value(kCols)) * bits_per_pixel)
                    fail("a word has bits beyond its last column");
                pixels_[first + bit / bits_per_pixel] |=
                    static_cast<std::uint8_t>(1U << bit % bits_per_pixel);
            }
        }
    }

    [[nodiscard]] unsigned nibble_of(char c) const {
        const char lower = c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
        const auto digit = kHexDigits.find(lower);
        if (digit == std::string_view::npos)
            fail(fmt::format("\"{}\" is not a hexadecimal digit", c));
        return static_cast<unsigned>(digit);
    }

    [[nodiscard]] SequencerProgram program_with(std::vector<std::uint8_t> pixels) const {
        return {.tile_rows = value(kRows),
                .tile_cols = value(kCols),
                .period_slots = value(kPeriod),
                .bits_per_pixel = value(kBits),
                .pixels = std::move(pixels)};
    }

    std::string_view rest_;
    std::size_t text_bytes_;
    const std::string& where_;
    int line_ = 0;
    bool is_ours_ = false;
    std::string name_ = "program";
    std::array<int, kFields> values_ = {};
    std::size_t address_ = 0;
    std::vector<bool> given_;
    std::vector<std::uint8_t> pixels_;
};

std::string word_text(const SequencerProgram& program, std::size_t word) {
    std::string text(digits_per_word(program), '0');
    const auto cols = index(program.tile_cols);
    const auto bits_per_pixel = index(program.bits_per_pixel);
    for (std::size_t digit = 0; digit < text.size(); ++digit) {
        unsigned nibble = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t bit = 4 * digit + i;
            if (bit >= cols * bits_per_pixel) break;
            const unsigned pixel = program.pixels[word * cols + bit / bits_per_pixel];
            nibble |= (pixel >> bit % bits_per_pixel & 1U) << i;
        }
        text[text.size() - 1 - digit] = kHexDigits[nibble];
    }
    return text;
}

}  // namespace

std::string program_text(const NamedProgram& named) {
    const SequencerProgram& program = named.program;
    constexpr std::array<std::string_view, 4> kFieldNames = {"", "read", "open, read",
                                                             "store, open, read"};
    std::string text = fmt::format(
        "// {}\n// name = {}\n// tile_rows = {}\n// tile_cols = {}\n// period_slots = {}\n"
        "// bits_per_pixel = {}\n// {} bits; word (address slot * tile_rows + row): column c in "
        "bits {}c up, from the highest: {}\n",
        kTitle, named.name, program.tile_rows, program.tile_cols, program.period_slots,
        program.bits_per_pixel, program.bits(), program.bits_per_pixel,
        kFieldNames[index(program.bits_per_pixel)]);
    const std::size_t words = index(program.period_slots) * index(program.tile_rows);
    for (std::size_t word = 0; word < words; ++word) {
        if (word % index(program.tile_rows) == 0)
            text += fmt::format("@{:x}  // slot {}\n", word, word / index(program.tile_rows));
        text += word_text(program, word) + '\n';
    }
    return text;
}

NamedProgram parse_program(std::string_view text, const std::string& where) {
    return Parser(text, where).parse();
}

}  // namespace stipple
