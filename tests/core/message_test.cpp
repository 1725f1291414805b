#include "core/message.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace stipple {
namespace {

std::string as_query(const Parameter& parameter) {
    return "?" + parameter.name + "=" + parameter.value;
}

const Message kAdvice = "slot 3 is missing; give " + Parameter{"fill_gaps", "true"} + " or raise " +
                        Parameter{"timeout"};

TEST(MessageTest, NamesParametersAsEachInterfaceDoes) {
    EXPECT_EQ(kAdvice.text(), "slot 3 is missing; give fill_gaps = true or raise timeout");
    EXPECT_EQ(kAdvice.text(as_query), "slot 3 is missing; give ?fill_gaps=true or raise ?timeout=");
    EXPECT_EQ(kAdvice.parameters(),
              (std::vector<Parameter>{{"fill_gaps", "true"}, {"timeout", ""}}));
}

TEST(MessageTest, WhatLooksLikeAParameterIsText) {
    const Message message = "fill_gaps = true.npy: " + Message("--force");
    EXPECT_EQ(message.text(as_query), "fill_gaps = true.npy: --force");
    EXPECT_TRUE(message.parameters().empty());
}

TEST(MessageTest, IsEmptyWithoutText) {
    EXPECT_TRUE(Message().empty());
    EXPECT_TRUE(Message("").empty());
    EXPECT_FALSE(Message(Parameter{"crop"}).empty());
}

TEST(MessageTest, CanBeAddedToItself) {
    Message message = "a" + Parameter{"b"};
    message += message;
    EXPECT_EQ(message.text(), "abab");
}

TEST(ErrorTest, ACopyKeepsPlaceFaultAndParameters) {
    const InputError error("clip.stipple", kAdvice);
    const InputError copy = error;
    EXPECT_EQ(copy.where(), Message("clip.stipple"));
    EXPECT_EQ(copy.fault(), kAdvice);
    EXPECT_EQ(copy.what(), "clip.stipple: " + kAdvice.text());
    EXPECT_EQ(copy.message().text(as_query), "clip.stipple: " + kAdvice.text(as_query));
}

}  // namespace
}  // namespace stipple
