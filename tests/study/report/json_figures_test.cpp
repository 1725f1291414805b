#include "study/report/json_figures.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "core/nested_figures.h"

namespace stipple {
namespace {

TEST(JsonFiguresTest, NestedFiguresAreObjectsAndListsArraysOfThem) {
    const std::vector<int> squared{2, 3};
    const auto json = json_of([&](const auto& add) {
        add("number", 1.5);
        add("unknown", std::optional<double>());
        add("known", std::optional<double>(2.5));
        add("nested", NestedFigures{[](const auto& inner) { inner("a", 1); }});
        add("list",
            FigureList{squared, [](int item, const auto& inner) { inner("square", item * item); }});
        add("none", FigureList{std::vector<int>(), [](int, const auto&) {}});
    });
    EXPECT_EQ(json.dump(), R"({"number":1.5,"unknown":null,"known":2.5,"nested":{"a":1},)"
                           R"("list":[{"square":4},{"square":9}],"none":[]})");
}

}  // namespace
}  // namespace stipple
