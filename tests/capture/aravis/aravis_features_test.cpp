#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "capture/aravis/aravis_camera.h"
#include "capture/aravis/aravis_device.h"
#include "core/error.h"
#include "tests/capture/aravis/fake_camera_process.h"
#include "tests/capture/aravis/genicam_file.h"
#include "tests/support/private_network.h"

namespace stipple {
namespace {

/// Features below Root.
std::string described(const std::vector<std::string>& names, const std::string& features) {
    std::string root = "<Category Name=\"Root\">";
    for (const std::string& name : names) root += "<pFeature>" + name + "</pFeature>";
    return root + "</Category>\n" + features;
}

/// Against Aravis' own fake camera, over UDP.
class AravisFeaturesTest : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string why = enter_private_network(); !why.empty()) GTEST_SKIP() << why;
    }
};

TEST_F(AravisFeaturesTest, FeaturesAreDescribedWithUnitRangeChoicesAndAccess) {
    const GenicamFile file(described(
        {"Gain", "Time", "Mode", "On", "Fixed", "Hidden"},
        "<Integer Name=\"Gain\"><ToolTip>of the amplifier</ToolTip><Value>4</Value><Min>2</Min>"
        "<Max>10</Max><Inc>2</Inc><Unit>dB</Unit></Integer>\n"
        "<Float "
        "Name=\"Time\"><Value>2.5</Value><Min>0.5</Min><Max>100</Max><Unit>us</Unit></Float>\n"
        "<Enumeration Name=\"Mode\"><EnumEntry Name=\"Slow\"><Value>0</Value></EnumEntry>"
        "<EnumEntry Name=\"Fast\"><Value>1</Value></EnumEntry><Value>1</Value></Enumeration>\n"
        "<Boolean Name=\"On\"><Value>1</Value></Boolean>\n"
        "<Integer Name=\"Fixed\"><pIsLocked>One</pIsLocked><Value>7</Value></Integer>\n"
        "<Integer Name=\"Hidden\"><pIsAvailable>Zero</pIsAvailable><Value>7</Value></Integer>\n"
        "<Integer Name=\"One\"><Value>1</Value></Integer>\n"
        "<Integer Name=\"Zero\"><Value>0</Value></Integer>\n"));
    const FakeCameraProcess camera({"genicam=" + file.path().string()});
    const auto features = aravis_features("gige:127.0.0.1");
    ASSERT_EQ(features.size(), 6U);
    EXPECT_EQ(features[0].name, "Gain");
    EXPECT_EQ(features[0].category, "Root");
    EXPECT_EQ(features[0].type, "integer");
    EXPECT_EQ(features[0].access, "rw");
    EXPECT_EQ(features[0].value, "4");
    EXPECT_EQ(features[0].unit, "dB");
    EXPECT_EQ(features[0].minimum, "2");
    EXPECT_EQ(features[0].maximum, "10");
    EXPECT_EQ(features[0].increment, "2");
    EXPECT_EQ(features[0].text, "of the amplifier");
    EXPECT_EQ(features[1].type, "float");
    EXPECT_EQ(features[1].value, "2.5");
    EXPECT_EQ(features[1].unit, "us");
    EXPECT_EQ(features[1].minimum, "0.5");
    EXPECT_EQ(features[1].maximum, "100");
    EXPECT_FALSE(features[1].increment.has_value());
    EXPECT_EQ(features[2].type, "choice");
    EXPECT_EQ(features[2].value, "Fast");
    EXPECT_EQ(features[2].choices, (std::vector<std::string>{"Slow", "Fast"}));
    EXPECT_EQ(features[3].type, "boolean");
    EXPECT_EQ(features[4].access, "ro");
    EXPECT_EQ(features[4].value, "7");
    EXPECT_EQ(features[5].access, "na");
    EXPECT_FALSE(features[5].value.has_value());
}

TEST_F(AravisFeaturesTest, LimitsThatNameEachOtherAreTold) {
    const auto knife = [](const std::string& name, const std::string& variable) {
        return "<IntSwissKnife Name=\"" + name + "\"><pVariable Name=\"X\">" + variable +
               "</pVariable><Formula>64-X</Formula></IntSwissKnife>\n";
    };
    const GenicamFile file(described(
        {"A", "B", "Own"},
        "<Integer Name=\"A\"><Value>3</Value><pMax>AMax</pMax></Integer>\n" + knife("AMax", "B") +
            "<Integer Name=\"B\"><Value>5</Value><pMax>BMax</pMax></Integer>\n" +
            knife("BMax", "A") +
            "<Integer Name=\"Own\"><Value>9</Value><pMin>Own</pMin><pMax>Own</pMax></Integer>\n"));
    const FakeCameraProcess camera({"genicam=" + file.path().string()});
    const auto features = aravis_features("gige:127.0.0.1");
    ASSERT_EQ(features.size(), 3U);
    EXPECT_EQ(features[0].maximum, "59");
    EXPECT_EQ(features[1].maximum, "61");
    EXPECT_EQ(features[2].maximum, "9");
}

TEST_F(AravisFeaturesTest, ACameraThatGoesAwayIsLostAtTheFirstQuestion) {
    const FakeCameraProcess camera;
    const AravisDevice device("gige:127.0.0.1");
    camera.freeze();
    try {
        static_cast<void>(describe_features(device));
        ADD_FAILURE() << "features of a camera that is gone";
    } catch (const DeviceError& e) {
        EXPECT_NE(std::string(e.what()).find("camera lost"), std::string::npos);
    }
    camera.thaw();
}

}  // namespace
}  // namespace stipple
