#include "readout/timing/waveform.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <span>

namespace stipple {
namespace {

constexpr std::array<std::string_view, 12> kNames{
    "cycle", "slot_start", "slot",       "overrun",  "code_load", "row_select",
    "row",   "adc_busy",   "link_valid", "link_row", "columns",   "channel_busy"};

/// The code of a signal in the file: '!', '"', ...
char code_of(std::size_t signal) {
    return static_cast<char>('!' + signal);
}

/// Binary digits without leading zeros; two's complement of `bits` bits if negative.
std::string binary(std::int64_t value, int bits) {
    auto rest = static_cast<std::uint64_t>(value);
    if (bits < 64) rest &= (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
    return fmt::format("{:b}", rest);
}

/// Time of a clock edge in ps. A rest below a second keeps the product within what a double holds.
std::int64_t picoseconds(std::int64_t cycle, std::int64_t clock_hz) {
    constexpr std::int64_t kPerSecond = 1'000'000'000'000;
    const double rest = static_cast<double>(cycle % clock_hz) / static_cast<double>(clock_hz);
    return cycle / clock_hz * kPerSecond + std::llround(rest * static_cast<double>(kPerSecond));
}

/// A name that every reader takes.
std::string identifier(std::string_view name) {
    std::string result(name);
    for (char& c : result)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return result.empty() ? "sensor" : result;
}

}  // namespace

Waveform::Waveform(const ReadoutTiming& timing, std::string_view sensor)
    : timing_(timing), sensor_(identifier(sensor)), now_(kSignals) {
    static_assert(kNames.size() == kSignals);
}

int Waveform::bits_of(Signal signal) const {
    switch (signal) {
        case kCycle:
        case kSlot:
            return 64;
        case kRow:
        case kLinkRow:
        case kColumns:
            return 32;
        case kChannelBusy:
            return timing_.addressing.channels;
        default:
            return 1;
    }
}

std::string Waveform::head() const {
    std::string text = fmt::format(
        "$version stipple $end\n"
        "$comment clock of {} Hz; times are rounded to ps, cycle is exact $end\n"
        "$timescale 1 ps $end\n"
        "$scope module {} $end\n",
        timing_.clock_hz, sensor_);
    for (std::size_t i = 0; i < kSignals; ++i) {
        const int bits = bits_of(static_cast<Signal>(i));
        text += fmt::format("$var wire {} {} {}{} $end\n", bits, code_of(i), kNames.at(i),
                            bits > 1 ? fmt::format(" [{}:0]", bits - 1) : "");
    }
    text += "$upscope $end\n$enddefinitions $end\n";
    return text;
}

std::string Waveform::view(std::string_view file) const {
    // Flags of GTKWave: how a signal is shown, or that the line is a comment.
    constexpr std::string_view kBits = "@28", kDecimal = "@24", kSigned = "@420", kComment = "@200";
    struct Group {
        std::string_view title;
        std::vector<Signal> signals;
    };
    const std::array groups{
        Group{"Clock and slots", {kCycle, kSlot, kSlotStart, kOverrun, kCodeLoad}},
        Group{"Conversion of a row", {kRow, kRowSelect, kAdcBusy}},
        Group{"Transfer of a row", {kLinkRow, kLinkValid, kColumns, kChannelBusy}}};
    std::string text =
        fmt::format("[*] readout of {}, by stipple\n[dumpfile] \"{}\"\n", sensor_, file);
    for (const Group& group : groups) {
        text += fmt::format("{}\n-{}\n", kComment, group.title);
        for (const Signal signal : group.signals) {
            const int bits = bits_of(signal);
            const bool is_row = signal == kRow || signal == kLinkRow;
            const bool is_bits = bits == 1 || signal == kChannelBusy;
            text += fmt::format("{}\n{}.{}{}\n",
                                is_row    ? kSigned
                                : is_bits ? kBits
                                          : kDecimal,
                                sensor_, kNames.at(signal),
                                bits > 1 ? fmt::format("[{}:0]", bits - 1) : "");
        }
    }
    return text;
}

void Waveform::set(std::int64_t cycle, Signal signal, std::int64_t value) {
    const int bits = bits_of(signal);
    changes_.push_back({cycle, signal,
                        bits == 1 ? std::string(value != 0 ? "1" : "0")
                                  : fmt::format("b{} ", binary(value, bits))});
}

void Waveform::set_channels(std::int64_t cycle, const std::vector<bool>& busy) {
    std::string value;
    for (auto channel = busy.rbegin(); channel != busy.rend(); ++channel)
        value += *channel ? '1' : '0';
    changes_.push_back(
        {cycle, kChannelBusy, busy.size() == 1 ? value : fmt::format("b{} ", value)});
}

void Waveform::add_row(const RowTimes& row, std::span<const int> channel_columns) {
    set(row.select, kRowSelect, 1);
    set(row.select, kRow, row.load.row);
    set(row.convert, kAdcBusy, 1);
    set(row.convert_end, kAdcBusy, 0);
    set(row.convert_end, kRowSelect, 0);
    set(row.transfer, kLinkValid, 1);
    set(row.transfer, kLinkRow, row.load.row);
    set(row.transfer, kColumns, row.load.columns);
    set(row.transfer_end, kLinkValid, 0);
    set(row.transfer_end, kColumns, 0);
    // A channel is busy in proportion to its columns.
    std::map<int, std::vector<std::size_t>> by_columns;
    for (std::size_t i = 0; i < channel_columns.size(); ++i)
        by_columns[channel_columns[i]].push_back(i);
    std::vector<bool> busy(channel_columns.size(), true);
    for (const auto& [columns, channels] : by_columns) {
        if (columns > 0 && columns == by_columns.begin()->first) set_channels(row.transfer, busy);
        for (const std::size_t channel : channels) busy[channel] = false;
        const std::int64_t clocks =
            (row.transfer_end - row.transfer) * columns / std::max(row.load.channel_columns, 1);
        set_channels(row.transfer + clocks, busy);
    }
}

std::string Waveform::take_until(std::int64_t cycle) {
    std::ranges::stable_sort(changes_, {}, &Change::cycle);
    const auto end = std::ranges::lower_bound(changes_, cycle, {}, &Change::cycle);
    std::string text;
    for (auto change = changes_.begin(); change != end;) {
        const auto next = std::find_if(
            change, end, [&](const Change& other) { return other.cycle != change->cycle; });
        std::array<const std::string*, kSignals> last{};
        for (const Change& same : std::span(change, next)) last.at(same.signal) = &same.value;
        std::string lines;
        for (std::size_t i = 0; i < kSignals; ++i) {
            if (last.at(i) == nullptr || *last.at(i) == now_[i]) continue;
            now_[i] = *last.at(i);
            lines += fmt::format("{}{}\n", now_[i], code_of(i));
        }
        if (!lines.empty())
            text += fmt::format("#{}\n{}b{} {}\n", picoseconds(change->cycle, timing_.clock_hz),
                                lines, binary(change->cycle, 64), code_of(kCycle));
        change = next;
    }
    changes_.erase(changes_.begin(), end);
    return text;
}

std::string Waveform::add_slot(ReadoutCost& cost) {
    const std::int64_t slot = cost.slots();
    const SlotCost& it = cost.add_next();
    const std::int64_t begin = it.begin;
    std::string before = take_until(begin);
    if (now_.front().empty()) {  // initial values
        now_.front().assign(1, '0');
        for (const Signal signal : {kRowSelect, kAdcBusy, kLinkValid}) set(begin, signal, 0);
        for (const Signal signal : {kRow, kLinkRow, kColumns}) set(begin, signal, 0);
        set_channels(
            begin, std::vector<bool>(static_cast<std::size_t>(timing_.addressing.channels), false));
    }
    set(begin, kSlotStart, 1);
    set(begin + 1, kSlotStart, 0);
    set(begin, kSlot, slot);
    set(begin, kOverrun, it.overrun ? 1 : 0);
    set(begin, kCodeLoad, timing_.code_load_clocks > 0 ? 1 : 0);
    set(begin + timing_.code_load_clocks, kCodeLoad, 0);
    const SlotTimes times = cost.times(slot, it);
    for (const RowTimes& row : times.rows)
        add_row(row, cost.row_loads().channel_columns(slot, row.load.row));
    return before;
}

std::string Waveform::tail(std::int64_t end) {
    set(end, kSlotStart, 0);
    for (const Change& change : changes_) end = std::max(end, change.cycle);
    return take_until(end + 1) + fmt::format("#{}\nb{} {}\n", picoseconds(end, timing_.clock_hz),
                                             binary(end, 64), code_of(kCycle));
}

}  // namespace stipple
