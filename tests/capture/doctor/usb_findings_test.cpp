#include "capture/doctor/doctor_findings.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <string>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Level = DoctorFinding::Level;

void write_files(const fs::path& root, const std::map<std::string, std::string>& files) {
    for (const auto& [name, text] : files) {
        fs::create_directories((root / name).parent_path());
        std::ofstream(root / name) << text << "\n";
    }
}

/// A camera at 2-1, and a mouse.
std::map<std::string, std::string> machine(const std::string& speed) {
    const std::string camera = "sys/bus/usb/devices/2-1/";
    return {{"sys/module/usbcore/parameters/usbfs_memory_mb", "16"},
            {camera + "busnum", "2"},
            {camera + "devnum", "7"},
            {camera + "serial", "4711"},
            {camera + "manufacturer", "Maker"},
            {camera + "product", "Camera"},
            {camera + "speed", speed},
            {camera + "idVendor", "1e10"},
            {camera + "2-1:1.0/bInterfaceClass", "ef"},
            {camera + "2-1:1.0/bInterfaceSubClass", "05"},
            {"sys/bus/usb/devices/1-3/1-3:1.0/bInterfaceClass", "03"}};
}

TEST(UsbFindingsTest, TooLittleMemoryForTransfersIsAWarningWithTheFix) {
    const TemporaryFolder folder;
    write_files(folder.path(), machine("5000"));
    const auto findings = usb_findings(folder.path());
    ASSERT_FALSE(findings.empty());
    EXPECT_EQ(findings[0].level, Level::kWarning);
    EXPECT_NE(findings[0].fact.find("16"), std::string::npos);
    EXPECT_NE(findings[0].fix.find("usbfs_memory_mb"), std::string::npos);
    for (const char* const enough : {"0", "1000"}) {
        write_files(folder.path(), {{"sys/module/usbcore/parameters/usbfs_memory_mb", enough}});
        EXPECT_EQ(usb_findings(folder.path())[0].level, Level::kGood);
    }
}

TEST(UsbFindingsTest, ACameraThatMayNotBeOpenedNamesItsRule) {
    const TemporaryFolder folder;
    write_files(folder.path(), machine("5000"));
    const auto findings = usb_findings(folder.path());
    ASSERT_EQ(findings.size(), 2);
    EXPECT_EQ(findings[1].subject, "usb:4711");
    EXPECT_EQ(findings[1].level, Level::kProblem);
    EXPECT_NE(findings[1].fix.find("ATTR{idVendor}==\"1e10\""), std::string::npos);
}

TEST(UsbFindingsTest, ACameraAtASlowPortIsAWarning) {
    const TemporaryFolder folder;
    for (const auto& [speed, level] : {std::pair("480", Level::kWarning), {"5000", Level::kGood}}) {
        auto files = machine(speed);
        files["dev/bus/usb/002/007"] = "";
        write_files(folder.path(), files);
        EXPECT_EQ(usb_findings(folder.path()).at(1).level, level) << speed;
    }
}

TEST(UsbFindingsTest, ACameraIsTakenWhileAProgramHasClaimedItsInterface) {
    const TemporaryFolder folder;
    write_files(folder.path(), machine("5000"));
    EXPECT_FALSE(usb_camera_is_taken("4711", folder.path()));
    const auto driver = folder.path() / "sys/bus/usb/devices/2-1/2-1:1.0/driver";
    fs::create_symlink("../../../../bus/usb/drivers/usbfs", driver);
    EXPECT_TRUE(usb_camera_is_taken("4711", folder.path()));
    EXPECT_FALSE(usb_camera_is_taken("4712", folder.path()));
    fs::remove(driver);
    fs::create_symlink("../../../../bus/usb/drivers/snd-usb-audio", driver);
    EXPECT_FALSE(usb_camera_is_taken("4711", folder.path()));
}

TEST(UsbFindingsTest, AMachineWithoutUsbIsFine) {
    const TemporaryFolder folder;
    const auto findings = usb_findings(folder.path());
    ASSERT_EQ(findings.size(), 1);
    EXPECT_EQ(findings[0].level, Level::kGood);
}

}  // namespace
}  // namespace stipple
