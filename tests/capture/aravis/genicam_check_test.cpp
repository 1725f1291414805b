#include "capture/aravis/genicam_description.h"

#include <arv.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace stipple {
namespace {

/// A camera that has these features.
class DescribedCamera {
  public:
    explicit DescribedCamera(const std::string& features) : device_(open(features)) {}
    ~DescribedCamera() { g_object_unref(device_); }
    DescribedCamera(const DescribedCamera&) = delete;
    DescribedCamera& operator=(const DescribedCamera&) = delete;
    [[nodiscard]] ArvDevice* device() const { return device_; }

  private:
    static ArvDevice* open(const std::string& features);
    ArvDevice* device_;
};

ArvDevice* DescribedCamera::open(const std::string& features) {
    const auto file = std::filesystem::path(testing::TempDir()) /
                      ("genicam_" + std::to_string(getpid()) + ".xml");
    std::ofstream(file) << "<?xml version=\"1.0\"?>\n<RegisterDescription ModelName=\"Loop\" "
                           "VendorName=\"Test\" "
                           "xmlns=\"http://www.genicam.org/GenApi/Version_1_0\">\n"
                        << features << "<Port Name=\"Device\"></Port>\n</RegisterDescription>\n";
    arv_set_fake_camera_genicam_filename(file.c_str());
    ArvDevice* device = arv_fake_device_new("test", nullptr);
    arv_set_fake_camera_genicam_filename(nullptr);
    std::filesystem::remove(file);
    return device;
}

/// What is wrong with a camera that has these features; empty if nothing.
std::string problem_of(const std::string& features) {
    const DescribedCamera camera(features);
    try {
        const GenicamCheck check(camera.device(), "fake:test");
    } catch (const DeviceError& e) {
        return e.what();
    }
    return {};
}

std::string integer(const std::string& name, const std::string& part) {
    return "<Integer Name=\"" + name + "\">" + part + "</Integer>\n";
}

std::string knife(const std::string& name, const std::string& variable, int times) {
    std::string text = "<IntSwissKnife Name=\"" + name + "\">";
    for (int i = 0; i < times; ++i) text += "<pVariable Name=\"X\">" + variable + "</pVariable>";
    return text + "<Formula>64-X</Formula></IntSwissKnife>\n";
}

TEST(GenicamCheckTest, AValueThatDependsOnItselfIsRefused) {
    const std::string problem = problem_of(integer("A", "<pValue>A</pValue>"));
    EXPECT_NE(problem.find("fake:test: describes itself in a circle: the value of its feature A"),
              std::string::npos)
        << problem;
    EXPECT_NE(problem_of(integer("A", "<pValue>B</pValue>") + knife("B", "A", 1)), "");
}

TEST(GenicamCheckTest, ACircleIsFoundAtOnceWhereEachTurnHasTwoWays) {
    const std::string twice = integer("A", "<pValue>A</pValue>");
    EXPECT_NE(problem_of(twice + twice).find("in a circle"), std::string::npos);
}

TEST(GenicamCheckTest, ACircleInXmlThatIsNotWellFormedIsRefused) {
    const std::string problem =
        problem_of(integer("A", "<pValue>A</pValue>") + "<Port><pAddress>A</pAddret>");
    EXPECT_NE(problem.find("describes itself in XML that is not well-formed"), std::string::npos)
        << problem;
}

TEST(GenicamCheckTest, AValueOfVeryManyIsRefused) {
    std::string doubling;  // 2^40 ways from the first to the last
    for (int i = 0; i < 40; ++i)
        doubling += knife("A" + std::to_string(i), "A" + std::to_string(i + 1), 2);
    EXPECT_NE(problem_of(doubling), "");
}

TEST(GenicamCheckTest, ARegisterMayHaveAnIndex) {
    EXPECT_EQ(problem_of("<IntReg Name=\"A\"><Address>256</Address><pIndex Offset=\"4\">B</pIndex>"
                         "<Length>4</Length><pPort>Device</pPort></IntReg>\n" +
                         integer("B", "<Value>1</Value>")),
              "");
}

std::string text_register(const std::string& name, const std::string& length) {
    return "<StringReg Name=\"" + name + "\"><Address>64</Address>" + length +
           "<AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>\n";
}

TEST(GenicamCheckTest, RegistersAreShortAltogether) {
    const auto of_bytes = [](const std::string& bytes) {
        return text_register("A", "<Length>" + bytes + "</Length>");
    };
    EXPECT_EQ(problem_of(of_bytes("4190000")), "");  // Aravis adds some short registers
    for (const char* const bytes : {"4194305", "2147483648", "9223372036854775807", "-1"}) {
        const std::string problem = problem_of(of_bytes(bytes));
        EXPECT_NE(problem.find("registers that are too long: with A of"), std::string::npos)
            << bytes << ": " << problem;
    }
    EXPECT_NE(problem_of(of_bytes("4194300") + text_register("B", "<Length>8</Length>")), "");
}

TEST(GenicamCheckTest, ALengthMayBeTheValueOfAFeature) {
    const std::string of_value = text_register("A", "<pLength>B</pLength>");
    EXPECT_EQ(problem_of(of_value + integer("B", "<Value>64</Value>")), "");
    EXPECT_NE(problem_of(of_value + integer("B", "<Value>9223372036854775807</Value>")), "");
    // 64 - 65, and the same through a register whose own length has to be right first.
    EXPECT_NE(problem_of(of_value + knife("B", "C", 1) + integer("C", "<Value>65</Value>")), "");
    const std::string number =
        "<IntReg Name=\"B\"><Address>256</Address><pLength>C</pLength>"
        "<pPort>Device</pPort></IntReg>\n";
    EXPECT_NE(problem_of(of_value + number + integer("C", "<Value>9223372036854775807</Value>")),
              "");
}

TEST(GenicamCheckTest, LengthsThatChangeAreCheckedAgain) {
    const DescribedCamera camera(text_register("A", "<pLength>B</pLength>") +
                                 integer("B", "<Value>64</Value>"));
    const GenicamCheck check(camera.device(), "fake:test");
    check.check_lengths();
    arv_device_set_integer_feature_value(camera.device(), "B", -1, nullptr);
    EXPECT_THROW(check.check_lengths(), DeviceError);
}

// Its address depends on a part of itself.
TEST(GenicamCheckTest, APartOfARegisterDependsOnTheRegister) {
    EXPECT_NE(problem_of("<StructReg Comment=\"A\"><pAddress>B</pAddress><Length>4</Length>"
                         "<pPort>Device</pPort><StructEntry Name=\"C\"><Bit>1</Bit></StructEntry>"
                         "</StructReg>\n" +
                         knife("B", "C", 1)),
              "");
}

TEST(GenicamCheckTest, LimitsMayNameEachOther) {
    EXPECT_EQ(problem_of(integer("A", "<Value>3</Value><pMax>AMax</pMax>") + knife("AMax", "B", 1) +
                         integer("B", "<Value>3</Value><pMax>BMax</pMax>") + knife("BMax", "A", 1)),
              "");
}

}  // namespace
}  // namespace stipple
