#include "study/decoders/own_decoder.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/error.h"

namespace stipple {
namespace {

OwnDecoder named_decoder(const std::string& name) {
    return {name, [](const auto&, const auto&) { return FluxVideo(); }};
}

/// What check_video throws of a decoder "own" whose video should have 2 frames of 3 x 2 pixels.
std::string fault_of(const FluxVideo& video) {
    try {
        check_video(named_decoder("own"), video, 2, {2, 3, 1});
    } catch (const DecoderFault& fault) {
        return fault.what();
    }
    return {};
}

TEST(OwnDecoderTest, NamesThatSayNothingOrAreTakenAreRefused) {
    for (const char* name : {"", "best", "naive", "two\nlines"})
        EXPECT_THROW(check_decoder(named_decoder(name)), InputError) << name;
    EXPECT_THROW(check_decoder(named_decoder(std::string(65, 'a'))), InputError);
    EXPECT_THROW(check_decoder({"own", {}}), InputError);
    EXPECT_NO_THROW(check_decoder(named_decoder(std::string(64, 'a'))));
}

TEST(OwnDecoderTest, AVideoOfAnotherShapeIsAFault) {
    EXPECT_EQ(fault_of(FluxVideo(2, {2, 3, 1})), "");
    EXPECT_EQ(fault_of(FluxVideo(1, {2, 3, 1})),
              "decoder \"own\": gave 1 frame of 3 x 2 pixels and 1 plane, not 2 frames of 3 x 2 "
              "pixels and 1 plane");
    EXPECT_NE(fault_of(FluxVideo(2, {3, 2, 1})), "");
    EXPECT_NE(fault_of(FluxVideo(2, {2, 3, 3})), "");
}

TEST(OwnDecoderTest, LightThatIsNotFiniteIsAFault) {
    for (const float light :
         {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        FluxVideo video(2, {2, 3, 1});
        video.plane(1, 0).row(1)[2] = light;
        const std::string fault = fault_of(video);
        EXPECT_NE(fault.find("frame 1 has light"), fault.npos) << fault;
        EXPECT_NE(fault.find("at row 1, col 2"), fault.npos) << fault;
    }
}

}  // namespace
}  // namespace stipple
