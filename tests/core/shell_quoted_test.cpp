#include "core/text.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>

namespace stipple {
namespace {

/// What the shell of this system takes `word` for.
std::string taken_by_shell(const std::string& word) {
    std::FILE* const pipe = popen(("printf %s " + word).c_str(), "r");
    std::array<char, 1000> text{};
    const std::size_t length = std::fread(text.data(), 1, text.size(), pipe);
    EXPECT_EQ(pclose(pipe), 0) << word;
    return {text.data(), length};
}

TEST(ShellQuotedTest, AShellTakesItForTheArgument) {
    std::string every;
    for (int c = 1; c < 256; ++c) every += static_cast<char>(c);
    for (const std::string& argument :
         {every, std::string("it's"), std::string("''"), std::string("a\n b\\"),
          std::string("$HOME"), std::string("~"), std::string("*"), std::string("-x")})
        EXPECT_EQ(taken_by_shell(shell_quoted(argument)), argument) << argument;
}

TEST(ShellQuotedTest, EachCharacterAloneIsTakenForItself) {
    // One shell for all: the words are printed one after the other.
    std::string words, characters;
    for (int c = 1; c < 256; ++c) {
        characters += static_cast<char>(c);
        words += ' ' + shell_quoted(std::string(1, static_cast<char>(c)));
    }
    EXPECT_EQ(taken_by_shell(words), characters);
}

TEST(ShellQuotedTest, PlainArgumentsStayAsTheyAre) {
    EXPECT_EQ(shell_quoted("clips/a_1.npy"), "clips/a_1.npy");
    EXPECT_EQ(shell_quoted("sensor.slot_us=3.5"), "sensor.slot_us=3.5");
    EXPECT_EQ(shell_quoted("frame_%04d.png"), "frame_%04d.png");
}

TEST(ShellQuotedTest, AnEmptyArgumentIsAWord) {
    EXPECT_EQ(shell_quoted(""), "''");
}

}  // namespace
}  // namespace stipple
