#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "io/footage_reader.h"
#include "study/explore/exploration.h"
#include "study/explore/space.h"

namespace stipple {

/// Nothing, a text, a figure or a count.
using TableValue = std::variant<std::monostate, std::string, double, int>;

struct TableCell {
    std::string column;
    TableValue value;
};

/// Point `number` in the columns of docs/explore.md: the values of its axes, its figures,
/// `limited_by`, `rung`, `slots` and `problem`; with several seeds the ends of intervals and the
/// rank too. A figure that does not exist is nothing.
[[nodiscard]] std::vector<TableCell> table_row(const Exploration& exploration,
                                               std::uint64_t number);

/// The means over all footage, where there is more than one: a row for each combination of the
/// other axes that all footage has on the last rung, with intervals and ranks over the footage, as
/// RFC 4180 has it. Empty: there is one footage, or no such combination.
[[nodiscard]] std::string footage_table(const Exploration& exploration);

/// The points that were reached as RFC 4180 has it, the names of the columns first.
[[nodiscard]] std::string csv_table(const Exploration& exploration);

/// Writes table.csv and, where footage_table has it, footage.csv into the results. \throws
/// DeviceError.
void write_tables(const Exploration& exploration);

/// What the page of an exploration holds at most. The best points come first.
struct PageBounds {
    std::size_t points = 5000;                           ///< the table holds all
    std::size_t picture_bytes = std::size_t{16} << 20U;  ///< of the pictures in base64
};

/// The page of an exploration (docs/explore.md): an HTML file that needs no other one. `command`
/// made it; empty: not known.
[[nodiscard]] std::string results_page(const Exploration& exploration, const std::string& title,
                                       const std::string& command, const PageBounds& bounds = {});

/// The clip of a trial.
struct PointClip {
    int slots;
    ComparedSlots compared;       ///< of these; empty: not known
    bool is_whole;                ///< the footage has no more slots
    FootageOptions reading = {};  ///< of the footage
    int seeds = 1;                ///< trials of the point
};

/// A point as a space of its own, TOML.
[[nodiscard]] std::string point_space(const Space& space, const SpacePoint& point,
                                      const PointClip& clip);

/// Lines of a shell that repeat a trial in an empty folder: `explore` with `point_space` and, where
/// the footage is as long as the trial and other commands can do it, each step. Paths of files stay
/// as they are.
[[nodiscard]] std::string point_commands(const Space& space, const SpacePoint& point,
                                         const PointClip& clip);

}  // namespace stipple
