#include "core/config.h"

#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

using Texts = std::vector<std::string>;

constexpr std::array<std::string_view, 2> kModes{"fast", "best"};

class ConfigTest : public testing::Test {
  protected:
    Config parse(std::string_view text, const Texts& overrides = {}) {
        write_text(folder_ / "sensor.toml", text);
        return {folder_ / "sensor.toml", overrides};
    }
    std::string parse_error(std::string_view text, const Texts& overrides = {}) {
        return message_of<InputError>([&] { parse(text, overrides); });
    }
    static double number(Config& config) { return config.number({"gain", {0, 100}}, 1); }

    TemporaryFolder folder_;
};

TEST_F(ConfigTest, ReadsEveryKindOfValueByItsDottedName) {
    Config config = parse(
        "gain = 2.5\nname = \"paper\"\n[adc]\nbit_depth = 10\ndither = true\n"
        "lengths = [1, 2, 4]\nmode.kind = \"fast\"\n");
    EXPECT_EQ(config.number({"gain", {0, 10}}, 0), 2.5);
    EXPECT_EQ(config.text({"name"}, ""), "paper");
    EXPECT_EQ(config.integer({"adc.bit_depth", {1, 16}}, 8), 10);
    EXPECT_TRUE(config.boolean({"adc.dither"}, false));
    EXPECT_EQ(config.integers({"adc.lengths", {1, 64}}, {}), (std::vector<int>{1, 2, 4}));
    EXPECT_EQ(config.choice({.name = "adc.mode.kind", .choices = kModes}, 1), 0U);
    EXPECT_NO_THROW(config.reject_unknown_keys());
}

TEST_F(ConfigTest, ReadsOneNumberOrAListOfNumbers) {
    Config config = parse("one = 2.5\nmany = [1, 0.5]\nnone = []\n");
    EXPECT_EQ(config.numbers({"one", {0, 10}}, {}), (std::vector<double>{2.5}));
    EXPECT_EQ(config.numbers({"many", {0, 10}}, {}), (std::vector<double>{1, 0.5}));
    EXPECT_EQ(config.numbers({"none", {0, 10}}, {7}), std::vector<double>{});
    EXPECT_EQ(config.numbers({"absent", {0, 10}}, {7}), std::vector<double>{7});
    EXPECT_NO_THROW(config.reject_unknown_keys());
    expect_parts(message_of<InputError>([&] {
                     return config.numbers({"many", {0, 0.75}}, {});
                 }),
                 {"sensor.toml:2: many", "1 is outside 0..0.75"});
    Config text = parse("a = [1, \"x\"]\n");
    expect_parts(message_of<InputError>([&] {
                     return text.numbers({"a", {0, 10}}, {});
                 }),
                 {"sensor.toml:1: a", "a number or a list of numbers"});
}

TEST_F(ConfigTest, RefusesKeysOfManyParts) {
    const auto dotted = [](int parts) {
        std::string key = "a";
        for (int i = 1; i < parts; ++i) key += ". \"b\"";
        return key;
    };
    for (const char* form : {"{} = 1", "[{}]", "[[{}]]", "x = {{ y = 1, {} = 1 }}"}) {
        EXPECT_NO_THROW(parse(fmt::format(fmt::runtime(form), dotted(32))));
        expect_parts(parse_error("# more\n" + fmt::format(fmt::runtime(form), dotted(33))),
                     {"sensor.toml:2", "more than 32 parts"});
    }
    EXPECT_EQ(parse("", {fmt::format("a={{{}=1}}", dotted(33))}).text({"a"}, "").front(), '{');
}

TEST_F(ConfigTest, RefusesLongKeysWithThoseOfTheirSections) {
    const std::string section(253, 'a');
    EXPECT_TRUE(parse(fmt::format("[{}]\nbc = 1\n", section)).contains(section + ".bc"));
    expect_parts(parse_error(fmt::format("[{}]\nbcd = 1\n", section)),
                 {"sensor.toml:2", "longer than 256"});
}

TEST_F(ConfigTest, TakesManyDotsThatAreInNoKey) {
    const std::string dots(100, '.');
    const std::string numbers = fmt::format("{}", fmt::join(std::vector(100, 1.5), ", "));
    Config config = parse(fmt::format(R"(# {0}
a = "{0}\"{0}"  # {0}
b = '{0}\'
c = """{0}"
{0}"""
d = '''{0}'
'''
"{0}" = 1
e = [{1}]
)",
                                      dots, numbers));
    EXPECT_EQ(config.text({"a"}, ""), dots + '"' + dots);
    EXPECT_EQ(config.text({"b"}, ""), dots + '\\');
    EXPECT_EQ(config.text({"c"}, ""), dots + "\"\n" + dots);
    EXPECT_EQ(config.text({"d"}, ""), dots + "'\n");
    EXPECT_EQ(config.integer({dots, {0, 1}}, 0), 1);
    EXPECT_EQ(config.numbers({"e", {1, 2}}, {}).size(), 100U);
}

TEST_F(ConfigTest, TellsWhetherAKeyIsGivenWithoutMakingItKnown) {
    Config config = parse("a = 1\n");
    EXPECT_TRUE(config.contains("a"));
    EXPECT_FALSE(config.contains("b"));
    EXPECT_THROW(config.reject_unknown_keys(), InputError);
}

TEST_F(ConfigTest, FallsBackForAbsentKeys) {
    Config config = parse("");
    EXPECT_EQ(config.number({"a", {0, 1}}, 0.1), 0.1);
    EXPECT_EQ(config.integer({"b", {0, 9}}, 7), 7);
    EXPECT_FALSE(config.boolean({"c"}, false));
    EXPECT_EQ(config.text({"d"}, "text"), "text");
    EXPECT_EQ(config.choice({.name = "e", .choices = kModes}, 1), 1U);
    EXPECT_EQ(config.integers({"f", {0, 9}}, {3}), std::vector<int>{3});
}

TEST_F(ConfigTest, TakesOneIntegerAsAListAndListsOfTexts) {
    Config config = parse("one = 3\ncode = ['A.', 'Aa']\nmixed = ['A', 1]\n");
    EXPECT_EQ(config.integers({"one", {1, 9}}, {}), std::vector<int>{3});
    EXPECT_EQ(config.texts({"code"}), (Texts{"A.", "Aa"}));
    EXPECT_TRUE(config.texts({"absent"}).empty());
    expect_parts(message_of<InputError>([&] { return config.texts({"mixed"}); }),
                 {"sensor.toml:3: mixed", "list of texts"});
    expect_parts(message_of<InputError>([&] { return config.texts({"one"}); }), {"list of texts"});
}

TEST_F(ConfigTest, TakesAnIntegerWhereANumberIsNeeded) {
    Config config = parse("gain = 3");
    EXPECT_EQ(number(config), 3.0);
}

TEST_F(ConfigTest, OverridesLieOverTheFile) {
    Config config = parse("gain = 1\n[adc]\nbit_depth = 8\n",
                          {"gain=2.5", "adc.bit_depth=10", "adc.lengths=[1,2]", "name=paper",
                           "quoted=\"a b\"", "on=true", "gain=7"});
    EXPECT_EQ(number(config), 7.0);
    EXPECT_EQ(config.integer({"adc.bit_depth", {1, 16}}, 0), 10);
    EXPECT_EQ(config.integers({"adc.lengths", {1, 64}}, {}), (std::vector<int>{1, 2}));
    EXPECT_EQ(config.text({"name"}, ""), "paper");
    EXPECT_EQ(config.text({"quoted"}, ""), "a b");
    EXPECT_TRUE(config.boolean({"on"}, false));
    EXPECT_NO_THROW(config.reject_unknown_keys());
}

TEST_F(ConfigTest, AnOverrideCannotSmuggleInOtherKeys) {
    Config config = parse("", {"name=1\ngain=5"});
    EXPECT_EQ(number(config), 1.0);
    EXPECT_EQ(config.text({"name"}, ""), "1\ngain=5");
}

TEST_F(ConfigTest, NamesTheLineOfASyntaxError) {
    expect_parts(parse_error("gain = 1\nname = \n"), {"sensor.toml:2:"});
    expect_parts(parse_error("gain = 1\ngain = 2\n"), {"sensor.toml:2:"});
}

TEST_F(ConfigTest, RefusesAFileThatIsMissingAFolderOrNoText) {
    expect_parts(message_of<InputError>([&] { Config(folder_ / "no.toml", {}); }),
                 {"no.toml: cannot be read", "No such file"});
    expect_parts(message_of<InputError>([&] { Config(folder_.path(), {}); }), {"cannot be read"});
    expect_parts(parse_error(std::string_view("\x89STP\0\xff", 6)), {"sensor.toml:1:"});
    expect_parts(parse_error(std::string(100000, '[')), {"sensor.toml:1:"});
}

TEST_F(ConfigTest, RefusesAnOverrideWithoutKeyOrValue) {
    for (const char* text : {"gain", "=5", "gain=", ""})
        expect_parts(parse_error("", {text}), {text + std::string(": "), "key=value"});
}

TEST_F(ConfigTest, NamesPlaceAndKeyOfAWrongType) {
    Config config = parse("\ngain = \"high\"\nbits = 8.0\nlist = [1, 2.5]\n[on]\nx = 1\n", {"t=5"});
    const auto expect = [](const std::string& message, const char* where, const char* problem) {
        expect_parts(message, {where, problem});
    };
    expect(message_of<InputError>([&] { return number(config); }),
           "sensor.toml:2: gain: ", "needs a number, but is text");
    expect(message_of<InputError>([&] {
               return config.integer({"bits", {1, 16}}, 8);
           }),
           "sensor.toml:3: bits: ", "needs an integer, but is a number");
    expect(message_of<InputError>([&] {
               return config.integers({"list", {1, 16}}, {});
           }),
           "sensor.toml:4: list: ", "needs a list of integers");
    expect(message_of<InputError>([&] { return config.boolean({"on.x"}, true); }),
           "sensor.toml:6: on.x: ", "needs true or false, but is an integer");
    expect(message_of<InputError>([&] { return config.text({"t"}, ""); }), "t: ", "needs text");
}

TEST_F(ConfigTest, RefusesValuesOutOfRangeAndTakesTheEnds) {
    for (const char* text : {"0", "100", "1e2"}) {
        Config config = parse("", {std::string("gain=") + text});
        EXPECT_NO_THROW(number(config));
    }
    for (const char* text : {"-1e-9", "100.5", "nan", "inf", "-inf"}) {
        Config config = parse("", {std::string("gain=") + text});
        expect_parts(message_of<InputError>([&] { return number(config); }),
                     {"gain: ", "is outside 0..100"});
    }
    Config config = parse(
        "bits = 17\nlist = [1, -1]\nbig = 9223372036854775807\n"
        "exact = 9007199254740992");
    expect_parts(message_of<InputError>([&] {
                     return config.integer({"bits", {1, 16}}, 8);
                 }),
                 {"sensor.toml:1: bits: 17 is outside 1..16"});
    expect_parts(message_of<InputError>([&] {
                     return config.integers({"list", {0, 9}}, {});
                 }),
                 {"sensor.toml:2: list: -1 is outside 0..9"});
    expect_parts(message_of<InputError>([&] {
                     return config.integers({"big", {0, 9}}, {});
                 }),
                 {"sensor.toml:3: big: ", "is outside 0..9"});
    EXPECT_EQ(config.integer({"exact", {0, 9007199254740992}}, 0), std::int64_t{1} << 53U);
}

TEST_F(ConfigTest, ListsTheChoices) {
    Config config = parse("mode = \"papr\"");
    expect_parts(message_of<InputError>(
                     [&] { return config.choice({.name = "mode", .choices = kModes}, 0); }),
                 {"sensor.toml:1: mode: \"papr\" is not one of fast, best"});
}

TEST_F(ConfigTest, SuggestsTheNearestKnownKeyForAnUnknownOne) {
    Config config = parse("gain = 1\n[adc]\nbit_deptj = 10\n");
    number(config);
    EXPECT_EQ(config.integer({"adc.bit_depth", {1, 16}}, 8), 8);
    expect_parts(message_of<InputError>([&] { config.reject_unknown_keys(); }),
                 {"sensor.toml:3: adc.bit_deptj: is unknown", "\"adc.bit_depth\""});
}

TEST_F(ConfigTest, ListsTheKnownKeysForAnUnknownOneThatIsLikeNone) {
    Config config = parse("colour = 1");
    number(config);
    EXPECT_EQ(config.integer({"adc.bit_depth", {1, 16}}, 8), 8);
    expect_parts(message_of<InputError>([&] { config.reject_unknown_keys(); }),
                 {"sensor.toml:1: colour: is unknown; known are adc.bit_depth, gain"});
}

TEST_F(ConfigTest, NoticesUnknownOverridesSectionsAndTablesInLists) {
    const auto unknown = [&](std::string_view text, const Texts& overrides) {
        Config config = parse(text, overrides);
        number(config);
        return message_of<InputError>([&] { config.reject_unknown_keys(); });
    };
    expect_parts(unknown("", {"gian=2"}), {"gian: is unknown", "\"gain\""});
    expect_parts(unknown("[empty]\n", {}), {"sensor.toml:1: empty: is unknown"});
    expect_parts(unknown("[[row]]\nx = 1\n", {}), {"sensor.toml:1: row: is unknown"});
    expect_parts(unknown("[gain]\nx = 1\n", {}), {"sensor.toml:2: gain.x: is unknown"});
}

TEST_F(ConfigTest, RefusesAQuotedKeyThatRepeatsADottedOne) {
    expect_parts(parse_error("\"adc.bits\" = 8\n[adc]\nbits = 10\n"), {"adc.bits: is given twice"});
}

TEST_F(ConfigTest, TellsASectionAsLinesThatMakeItAgain) {
    const std::vector<std::string> given{"timing.row_timing=sequential",
                                         "timing.clock_hz=90_000_000", "timing.settle=[19, 2]",
                                         "gain=1e-3", "name=\"a \\\"b\""};
    Config config(given);
    const std::string lines = config.as_toml("timing");
    EXPECT_EQ(lines, "clock_hz = 90000000\nrow_timing = 'sequential'\nsettle = [ 19, 2 ]\n");
    Config again = parse(config.as_toml(""));
    EXPECT_EQ(again.as_toml(""), config.as_toml(""));
    EXPECT_EQ(again.text({"name"}, ""), "a \"b");
    EXPECT_EQ(again.number({"gain", {0, 1}}, 0), 1e-3);
}

TEST_F(ConfigTest, TellsWhatItsReadersSaidOfTheKeys) {
    Config config(Texts{"c=3"});
    static_cast<void>(config.number({"a", {0, 1}, "m", "length"}, static_cast<double>(0.1F)));
    static_cast<void>(config.integer({"b", {1, 9}, "slots"}, 0));  // out of range: none
    static_cast<void>(config.integers({"c", {1, 9}}, {1, 2}));
    static_cast<void>(config.choice({.name = "d", .choices = kModes}, 1));
    static_cast<void>(config.text({"e"}, ""));
    static_cast<void>(config.boolean({"f"}, true));
    const auto keys = config.known_keys();
    const auto expected = std::vector<KnownKey>{
        {"a", "0.1", "0..1", "m", "length"}, {"b", "", "1..9", "slots", ""},
        {"c", "[1, 2]", "1..9", "", ""},     {"d", "best", "fast, best", "", ""},
        {"e", "\"\"", "", "", ""},           {"f", "true", "", "", ""}};
    EXPECT_EQ(keys, expected);
}

}  // namespace
}  // namespace stipple
