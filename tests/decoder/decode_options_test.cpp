#include "decoder/decode_options.h"

#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace stipple {
namespace {

DecodeOptions options_of(DecodeMethod method, const std::vector<std::string>& settings) {
    Config config(settings);
    return read_decode_options(method, config);
}

std::string refusal(DecodeMethod method, const std::string& setting) {
    try {
        static_cast<void>(options_of(method, {setting}));
    } catch (const InputError& e) {
        return e.what();
    }
    return {};
}

TEST(DecodeOptionsTest, KnowsTheNameOfEachMethod) {
    for (const NamedDecodeMethod& known : decode_methods())
        EXPECT_EQ(decode_method_from_name(known.name), known.method) << known.name;
    EXPECT_THROW(static_cast<void>(decode_method_from_name("")), InputError);
}

TEST(DecodeOptionsTest, LeavesTheDefaultsWhereNothingIsSet) {
    const DecodeOptions options = options_of(DecodeMethod::kFast, {});
    EXPECT_EQ(options.method, DecodeMethod::kFast);
    EXPECT_EQ(options.fast.rounds, MotionTvOptions{}.rounds);
    EXPECT_EQ(options.fast.step, MotionTvOptions{}.step);
}

TEST(DecodeOptionsTest, ChangesWhatIsSet) {
    const DecodeOptions options =
        options_of(DecodeMethod::kFast, {"rounds=5", "along_motion.temporal_weight=60.5"});
    EXPECT_EQ(options.fast.rounds, 5);
    EXPECT_EQ(options.fast.along_motion.temporal_weight, 60.5F);
    EXPECT_EQ(options.fast.static_tv.temporal_weight, MotionTvOptions{}.static_tv.temporal_weight);
}

TEST(DecodeOptionsTest, RefusesWhatTheMethodDoesNotKnowOrCannotTake) {
    EXPECT_NE(refusal(DecodeMethod::kNaive, "rounds=5").find("rounds"), std::string::npos);
    EXPECT_NE(refusal(DecodeMethod::kFast, "round=5").find("did you mean \"rounds\""),
              std::string::npos);
    EXPECT_NE(refusal(DecodeMethod::kFast, "rounds=101").find("0..100"), std::string::npos);
    EXPECT_NE(refusal(DecodeMethod::kFast, "step=nan").find("step"), std::string::npos);
    EXPECT_NE(refusal(DecodeMethod::kFast, "rounds=many").find("integer"), std::string::npos);
}

}  // namespace
}  // namespace stipple
