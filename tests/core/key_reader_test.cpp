#include "core/config.h"

#include <gtest/gtest.h>

#include <array>
#include <string_view>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

enum class Mode : std::uint8_t { kFast, kBest };
constexpr std::array<std::string_view, 2> kModes{"fast", "best"};
constexpr KeyRange kRange{0, 9};

struct Values {
    double number = 1;
    float single = 2;
    int integer = 3;
    std::int64_t wide = 4;
    bool flag = false;
    std::string text = "five";
    std::vector<int> integers = {6};
    std::vector<double> numbers = {7};
    Mode mode = Mode::kFast;

    bool operator==(const Values&) const = default;
};

Values read(const std::vector<std::string>& settings) {
    Config config(settings);
    const KeyReader key(config, "a.");
    Values values;
    key({"number", kRange}, values.number);
    key({"single", kRange}, values.single);
    key({"integer", kRange}, values.integer);
    key({"wide", {0, 1e11}}, values.wide);
    key({"flag"}, values.flag);
    key({"text"}, values.text);
    key({"integers", kRange}, values.integers);
    key({"numbers", kRange}, values.numbers);
    key({.name = "mode", .choices = kModes}, values.mode);
    config.reject_unknown_keys();
    return values;
}

TEST(KeyReaderTest, LeavesVariablesWhoseKeysAreAbsent) {
    EXPECT_EQ(read({}), Values{});
}

TEST(KeyReaderTest, SetsVariablesOfEachType) {
    EXPECT_EQ(read({"a.number=0.5", "a.single=1.5", "a.integer=2", "a.wide=100000000000",
                    "a.flag=true", "a.text=x", "a.integers=[1,2]", "a.numbers=0.5", "a.mode=best"}),
              (Values{0.5, 1.5F, 2, 100'000'000'000, true, "x", {1, 2}, {0.5}, Mode::kBest}));
}

TEST(KeyReaderTest, NamesAKeyWithItsSection) {
    EXPECT_EQ(message_of<InputError>([] { return read({"a.integer=10"}); }),
              "a.integer: 10 is outside 0..9");
}

}  // namespace
}  // namespace stipple
