#include "capture/aravis/genicam_check.h"

#include <arv.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/error.h"

namespace stipple {
namespace {

/// What is wrong with a camera that has these features; empty if nothing.
std::string problem_of(const std::string& features) {
    const auto file = std::filesystem::path(testing::TempDir()) /
                      ("genicam_" + std::to_string(getpid()) + ".xml");
    std::ofstream(file) << "<?xml version=\"1.0\"?>\n<RegisterDescription ModelName=\"Loop\" "
                           "VendorName=\"Test\" "
                           "xmlns=\"http://www.genicam.org/GenApi/Version_1_0\">\n"
                        << features << "<Port Name=\"Device\"></Port>\n</RegisterDescription>\n";
    arv_set_fake_camera_genicam_filename(file.c_str());
    ArvDevice* device = arv_fake_device_new("test", nullptr);
    std::string problem;
    try {
        check_genicam(device, "fake:test");
    } catch (const DeviceError& e) {
        problem = e.what();
    }
    g_object_unref(device);
    arv_set_fake_camera_genicam_filename(nullptr);
    std::filesystem::remove(file);
    return problem;
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

TEST(GenicamCheckTest, LimitsMayNameEachOther) {
    EXPECT_EQ(problem_of(integer("A", "<Value>3</Value><pMax>AMax</pMax>") + knife("AMax", "B", 1) +
                         integer("B", "<Value>3</Value><pMax>BMax</pMax>") + knife("BMax", "A", 1)),
              "");
}

}  // namespace
}  // namespace stipple
