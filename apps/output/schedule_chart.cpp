#include "apps/output/schedule_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>

#include "core/error.h"
#include "io/footage_files.h"
#include "io/text_file.h"
#include "study/report/chart.h"

namespace stipple {
namespace {

/// A rectangle of the diagram, in slots and rows from the top.
struct Box {
    double left;
    double right;
    double top;
    double bottom;
};

/// The boxes of a diagram by slots of light, the lines across gaps, and the readings, which have no
/// width.
struct Drawing {
    std::map<int, std::vector<Box>> boxes;
    std::vector<Box> lines;
    std::vector<Box> reads;
};

/// Adds an exposure that begins in `begin`, cut off at 0 and `slots`.
void add_exposure(Drawing& drawing, const Exposure& e, std::int64_t begin, const Box& lane) {
    const auto cut = [&](std::int64_t slot) {
        return std::clamp(static_cast<double>(slot), lane.left, lane.right);
    };
    for (int age = 0; age < e.span_slots();) {
        const int open = std::countr_one(e.open_slots >> static_cast<unsigned>(age));
        const Box box{cut(begin + age), cut(begin + age + open), lane.top, lane.bottom};
        if (box.left < box.right) drawing.boxes[e.light_slots()].push_back(box);
        age += std::max(open, 1);
    }
    const double middle = (lane.top + lane.bottom) / 2;
    const Box line{cut(begin), cut(begin + e.span_slots()), middle, middle};
    if (e.light_slots() < e.span_slots() && line.left < line.right) drawing.lines.push_back(line);
    const auto end = static_cast<double>(begin + e.span_slots());
    if (lane.left < end && end <= lane.right) drawing.reads.push_back({end, end, middle, middle});
}

void add_pixel(Drawing& drawing, const ScheduleDiagram& diagram, std::size_t at) {
    const ExposureSchedule& schedule = diagram.schedule;
    const int row = diagram.pixels[at].row % schedule.tile_rows();
    const int col = diagram.pixels[at].col % schedule.tile_cols();
    const auto exposures = schedule.exposures(row, col);
    const bool two = schedule.charge_stores() == 2;
    const double top = static_cast<double>(at) + 0.12;
    const double height = two ? 0.38 : 0.76;
    for (std::int64_t n = -1; n * schedule.period_slots() < diagram.slots; ++n)
        for (std::size_t i = 0; i < exposures.size(); ++i) {
            const double lane_top = top + height * schedule.store(row, col, i, n + 2);
            const Box lane{0, static_cast<double>(diagram.slots), lane_top, lane_top + height};
            add_exposure(drawing, exposures[i],
                         n * schedule.period_slots() + exposures[i].first_slot, lane);
        }
}

/// Light for few slots to dark for many: viridis at five points.
std::string colour(std::size_t i, std::size_t count) {
    struct Rgb {
        int red, green, blue;
    };
    constexpr Rgb kPoints[] = {
        {253, 231, 37}, {94, 201, 98}, {33, 145, 140}, {59, 82, 139}, {68, 1, 84}};
    const double at = count < 2 ? 2 : 4.0 * static_cast<double>(i) / static_cast<double>(count - 1);
    const auto low = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
    const double part = at - static_cast<double>(low);
    const auto mix = [&](int a, int b) { return static_cast<int>(a + part * (b - a) + 0.5); };
    const auto [a, b] = std::pair(kPoints[low], kPoints[low + 1]);
    return fmt::format("#{:02x}{:02x}{:02x}", mix(a.red, b.red), mix(a.green, b.green),
                       mix(a.blue, b.blue));
}

/// gnuplot's single quotes, in which a quote is written twice.
std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text)
        result += c == '\'' ? "''" : std::string(1, c >= 0 && c < ' ' ? ' ' : c);
    return result + "'";
}

std::string data_of(const std::string& name, const std::vector<Box>& boxes) {
    std::string text = fmt::format("${} << END\n", name);
    for (const Box& b : boxes)
        text += fmt::format("{} {} {} {} {} {}\n", (b.left + b.right) / 2, (b.top + b.bottom) / 2,
                            b.left, b.right, b.top, b.bottom);
    return text + "END\n";
}

std::string commands_of(const ScheduleDiagram& diagram, const Drawing& drawing) {
    const auto rows = diagram.pixels.size();
    const bool two = diagram.schedule.charge_stores() == 2;
    std::string text = data_of("gaps", drawing.lines) + data_of("reads", drawing.reads);
    for (const auto& [light, boxes] : drawing.boxes)
        text += data_of(fmt::format("light{}", light), boxes);
    text += fmt::format(
        "set title {}\nset xrange [0:{}]\nset yrange [{}:0]\n"
        "set xlabel 'time, slots'\nset ylabel 'pixel (row, column){}'\n"
        "set border 0\nset tics nomirror scale 0.5\nset key above\n"
        "set arrow from graph 0,0 to graph 1.02,0 filled\n"
        "set grid xtics lc rgb '#d0d0d0'\nset style fill solid border lc rgb 'black'\n"
        "set ytics (",
        quoted("Schedule " + diagram.name), diagram.slots, rows, two ? ", charge store" : "");
    for (std::size_t i = 0; i < rows; ++i) {
        const auto [row, col] = diagram.pixels[i];
        text += i > 0 ? ", " : "";
        text += two ? fmt::format("'({}, {})  1' {}.31, '2' {}.69", row, col, i, i)
                    : fmt::format("'({}, {})' {}.5", row, col, i);
    }
    text += ")\nplot ";
    if (!drawing.lines.empty())
        text += "$gaps using 3:2:($4-$3):(0) with vectors nohead lc rgb '#808080' lw 1.5 notitle, ";
    std::size_t i = 0;
    for (const auto& [light, boxes] : drawing.boxes)
        text += fmt::format(
            "$light{} using 1:2:3:4:5:6 with boxxyerror fc rgb '{}' title '{} "
            "slot{} of light', ",
            light, colour(i++, drawing.boxes.size()), light, light == 1 ? "" : "s");
    if (drawing.reads.empty()) return text + "1/0 notitle\n";
    return text + "$reads using 1:2 with points pt 7 ps 0.6 lc rgb 'black' title 'read'\n";
}

}  // namespace

void draw_schedule(const std::filesystem::path& file, bool force, const ScheduleDiagram& diagram) {
    const std::string extension = lower_extension(file);
    if (extension != ".png" && extension != ".svg")
        throw InputError(file.string(), "a diagram is a .png or a .svg");
    Drawing drawing;
    for (std::size_t i = 0; i < diagram.pixels.size(); ++i) add_pixel(drawing, diagram, i);
    PendingOutput pending(file, force);
    const int row_height = diagram.schedule.charge_stores() == 2 ? 44 : 34;
    const int height = 140 + row_height * static_cast<int>(diagram.pixels.size());
    write_text(pending, draw_chart(extension, {.width = 1000, .height = height},
                                   commands_of(diagram, drawing)));
}

}  // namespace stipple
