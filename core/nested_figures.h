#pragma once

#include <utility>
#include <vector>

namespace stipple {

// Values that a function `visit_..._figures` adds beside numbers and texts.

/// Figures under one name: those that `visit(add)` adds.
template <typename Visit>
struct NestedFigures {
    Visit visit;
};
template <typename Visit>
NestedFigures(Visit) -> NestedFigures<Visit>;

/// A list: for each item the figures that `visit(item, add)` adds. `items` must outlive it.
template <typename Item, typename Visit>
struct FigureList {
    FigureList(const std::vector<Item>& all, Visit visit_item)
        : items(all), visit(std::move(visit_item)) {}

    const std::vector<Item>& items;
    Visit visit;
};

}  // namespace stipple
