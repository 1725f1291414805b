#include "readout/schedules/code_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "readout/program/sequencer_program.h"
#include "readout/schedules/schedule_builder.h"

namespace stipple {
namespace {

constexpr std::size_t kLineWidth = 96;
constexpr std::size_t kWeightDigits = 4;
constexpr int kWeightOne = 0xFFFF;

struct Store {
    char begin;
    char open;
};
constexpr Store kStores[] = {{'A', 'a'}, {'B', 'b'}};

/// Reads the strings of a code.
class CodeReader {
  public:
    CodeReader(TileSize size, const Message& where)
        : size_(size), where_(where), list_(size.rows, size.cols, size.period_slots) {}

    void add_pixel(std::size_t pixel, std::string_view slots) {
        pixel_ = pixel;
        if (slots.size() != static_cast<std::size_t>(size_.period_slots))
            throw InputError(where_, fmt::format("{}: has {} slots; period_slots is {}",
                                                 pixel_name(), slots.size(), size_.period_slots));
        for (std::size_t slot = 0; slot < slots.size(); ++slot)
            if (std::string_view(".AaBb").find(slots[slot]) == std::string_view::npos)
                fail(slot, fmt::format("'{}' is none of . A a B b", printable(slots[slot])));
        for (const Store& store : kStores) add_store(slots, store);
        list_.end_pixel();
    }
    [[nodiscard]] ExposureSchedule schedule() && { return std::move(list_).schedule(); }

  private:
    /// The exposures of one store: it is walked once around from the first that begins.
    void add_store(std::string_view slots, const Store& store) {
        const std::size_t first = slots.find(store.begin);
        if (first == std::string_view::npos) {
            const std::size_t open = slots.find(store.open);
            if (open != std::string_view::npos)
                fail(open, fmt::format("'{}' goes on with an exposure that no '{}' begins",
                                       store.open, store.begin));
            return;
        }
        std::size_t begin = first;
        std::uint64_t mask = 1;
        for (std::size_t i = first + 1; i < first + slots.size(); ++i) {
            const char c = slots[i % slots.size()];
            if (c == store.begin) {
                list_.add(static_cast<std::uint32_t>(begin), mask);
                begin = i;
                mask = 1;
            } else if (c == store.open) {
                if (i - begin >= kMaxExposureSlots)
                    fail(begin % slots.size(),
                         fmt::format("this exposure spans {} slots or more; {} are the most",
                                     i - begin + 1, kMaxExposureSlots));
                mask |= std::uint64_t{1} << (i - begin);
            }
        }
        list_.add(static_cast<std::uint32_t>(begin), mask);
    }

    static std::string printable(char c) {
        return c >= ' ' && c <= '~' ? std::string(1, c)
                                    : fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
    [[nodiscard]] std::string pixel_name() const {
        const auto cols = static_cast<std::size_t>(size_.cols);
        return fmt::format("pixel ({}, {})", pixel_ / cols, pixel_ % cols);
    }
    [[noreturn]] void fail(std::size_t slot, std::string_view problem) const {
        throw InputError(where_, fmt::format("{} slot {}: {}", pixel_name(), slot, problem));
    }

    TileSize size_;
    const Message& where_;
    ScheduleBuilder list_;
    std::size_t pixel_ = 0;
};

std::string code_of(const ExposureSchedule& schedule, int row, int col, int periods) {
    const auto period = static_cast<std::size_t>(schedule.period_slots());
    std::string code(period * static_cast<std::size_t>(periods), '.');
    const auto exposures = schedule.exposures(row, col);
    for (int n = 0; n < periods; ++n)
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            const Store& store = kStores[schedule.store(row, col, i, n)];
            const std::size_t begin =
                static_cast<std::size_t>(n) * period + exposures[i].first_slot;
            for (std::uint64_t rest = exposures[i].open_slots; rest != 0; rest &= rest - 1) {
                const auto age = static_cast<std::size_t>(std::countr_zero(rest));
                code[(begin + age) % code.size()] = age == 0 ? store.begin : store.open;
            }
        }
    return code;
}

/// The weights of a pixel as text.
std::string weights_of(const ExposureSchedule& schedule, int row, int col, int periods) {
    std::string text;
    for (int slot = 0; slot < periods * schedule.period_slots(); ++slot) {
        const float weight = schedule.weight(slot % schedule.period_slots(), row, col);
        if (weight > 1)
            throw InputError("exposure schedule",
                             fmt::format("pixel ({}, {}) slot {}: weight {} is above 1, which a "
                                         "schedule file cannot hold; divide the masks by their "
                                         "maximum",
                                         row, col, slot, weight));
        const long code = std::lround(weight * static_cast<float>(kWeightOne));
        text += fmt::format("{:04X}", weight > 0 ? std::max(code, 1L) : 0L);
    }
    return text;
}

/// `text` as a TOML string.
std::string toml_string(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            result += std::string("\\") + c;
        else if ((c >= 0 && c < ' ') || c == '\x7f')
            result += fmt::format("\\u{:04X}", static_cast<unsigned>(c));
        else
            result += c;
    }
    return result + "\"";
}

}  // namespace

ExposureSchedule code_schedule(TileSize size, std::span<const std::string> code,
                               const Message& where) {
    const std::size_t pixels =
        static_cast<std::size_t>(size.rows) * static_cast<std::size_t>(size.cols);
    if (code.size() != pixels)
        throw InputError(where, fmt::format("holds {} pixels; a tile of {} x {} has {}",
                                            code.size(), size.rows, size.cols, pixels));
    CodeReader reader(size, where);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) reader.add_pixel(pixel, code[pixel]);
    return std::move(reader).schedule();
}

std::vector<float> code_weights(TileSize size, std::span<const std::string> texts,
                                const Message& where) {
    const auto pixels = static_cast<std::size_t>(size.rows) * static_cast<std::size_t>(size.cols);
    const auto slots = static_cast<std::size_t>(size.period_slots);
    if (texts.size() != pixels)
        throw InputError(where, fmt::format("holds {} pixels; a tile of {} x {} has {}",
                                            texts.size(), size.rows, size.cols, pixels));
    std::vector<float> weights(slots * pixels);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        const std::string_view text = texts[pixel];
        const bool digits = text.find_first_not_of("0123456789ABCDEFabcdef") == text.npos;
        if (!digits || text.size() != kWeightDigits * slots)
            throw InputError(where, fmt::format("pixel ({}, {}): needs {} hexadecimal digits, four "
                                                "for each slot",
                                                pixel / static_cast<std::size_t>(size.cols),
                                                pixel % static_cast<std::size_t>(size.cols),
                                                kWeightDigits * slots));
        for (std::size_t slot = 0; slot < slots; ++slot) {
            unsigned code = 0;
            const char* const begin = text.data() + kWeightDigits * slot;
            std::from_chars(begin, begin + kWeightDigits, code, 16);
            weights[slot * pixels + pixel] =
                static_cast<float>(code) / static_cast<float>(kWeightOne);
        }
    }
    return weights;
}

std::string code_text(const ExposureSchedule& schedule, const std::string& name) {
    if (schedule.charge_stores() > 2)
        throw InputError(
            "exposure schedule",
            fmt::format("needs {} charge stores; a code names two", schedule.charge_stores()));
    const int periods = stores_alternate(schedule) ? 2 : 1;
    const int rows = schedule.tile_rows();
    const int cols = schedule.tile_cols();
    const auto slots =
        static_cast<std::size_t>(periods) * static_cast<std::size_t>(schedule.period_slots());
    if (static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols) * slots > kMaxCodeSlots)
        throw InputError("exposure schedule",
                         fmt::format("a tile of {} x {} pixels and {} slots is more than the 2^24 "
                                     "characters that a code file may have; use a smaller tile",
                                     rows, cols, slots));
    const bool row_per_line = static_cast<std::size_t>(cols) * (slots + 4) <= kLineWidth;
    std::string text = fmt::format(
        "# Made by stipple schedule (docs/schedules.md, kind \"code\").\n\n"
        "kind = \"code\"\nname = {}        # for messages and the stream's header\n"
        "tile_rows = {}      # pixels\ntile_cols = {}      # pixels\n"
        "period_slots = {}   # slots after which all repeats\n"
        "# A string per pixel, row by row, a character per slot: . closed, A begins an exposure, "
        "a\n"
        "# goes on with it; B and b in the pixel's second charge store.\ncode = [\n",
        toml_string(name), rows, cols, slots);
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            const bool ends_line = !row_per_line || col + 1 == cols;
            text += fmt::format("{}\"{}\",{}", row_per_line && col > 0 ? " " : "    ",
                                code_of(schedule, row, col, periods), ends_line ? "\n" : "");
        }
    if (!schedule.weighted()) return text + "]\n";
    text +=
        "]\n# The parts of the light that open slots collect: four hexadecimal digits per slot, "
        "FFFF is\n# all of it.\nweights = [\n";
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            text += fmt::format("    \"{}\",\n", weights_of(schedule, row, col, periods));
    return text + "]\n";
}

}  // namespace stipple
