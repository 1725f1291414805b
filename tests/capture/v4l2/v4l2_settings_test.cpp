// Emulated ioctl: settings of a V4L2 camera, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <map>

#include "capture/v4l2/v4l2_camera.h"
#include "core/error.h"
#include "io/pixel_format.h"
#include "tests/capture/emulated_camera.h"

namespace stipple {
namespace {

using testing::HasSubstr;

/// What opening with these settings throws.
template <typename Error>
std::string error_of(const CameraSettings& settings, int frames = 4) {
    try {
        open_emulated(settings, frames);
    } catch (const Error& error) {
        return error.what();
    } catch (const std::exception& error) {
        return std::string("another type of error: ") + error.what();
    }
    return "no error";
}

EmulatedControl control(std::uint32_t id, const char* name, std::uint32_t type,
                        std::pair<std::int64_t, std::int64_t> range, std::int64_t value) {
    EmulatedControl made;
    made.about.id = id;
    made.about.type = type;
    std::strncpy(made.about.name, name, sizeof made.about.name - 1);
    made.about.minimum = range.first;
    made.about.maximum = range.second;
    made.about.step = 1;
    made.value = value;
    return made;
}

EmulatedDriver driver_with_controls() {
    EmulatedDriver driver;
    driver.controls = {
        control(V4L2_CID_BRIGHTNESS, "Brightness", V4L2_CTRL_TYPE_INTEGER, {0, 255}, 128),
        control(V4L2_CID_AUTOGAIN, "Gain, Automatic", V4L2_CTRL_TYPE_BOOLEAN, {0, 1}, 1),
        control(V4L2_CID_GAIN, "Gain", V4L2_CTRL_TYPE_INTEGER, {0, 100}, 5),
        control(V4L2_CID_EXPOSURE_AUTO, "Exposure, Auto", V4L2_CTRL_TYPE_MENU, {0, 3}, 3),
        control(V4L2_CID_EXPOSURE_ABSOLUTE, "Exposure Time, Absolute", V4L2_CTRL_TYPE_INTEGER,
                {1, 5000}, 157)};
    driver.controls[0].about.step = 5;
    driver.controls[3].menu = {"", "Manual Mode", "", "Aperture Priority Mode"};
    return driver;
}

TEST(V4l2SettingsTest, EveryRawFormatIsSetAndReadWithoutConversion) {
    for (const PixelFormat& format : pixel_formats()) {
        if (format.v4l2 == 0) continue;
        EmulatedDriver driver;
        driver.formats = {V4L2_PIX_FMT_YUYV, format.v4l2};
        driver.bits_per_pixel = static_cast<std::uint32_t>(format.bits_per_pixel);
        EmulatedV4l2 emulated(driver);
        const std::size_t size = format.row_bytes(16) * 8;
        emulated.push(ramp_frame(size, 1));
        const auto camera = open_emulated({{"PixelFormat", std::string(format.name)}});
        EXPECT_EQ(camera->layout().format, &format);
        camera->start();
        const CapturedFrame frame = frame_from(*camera);
        EXPECT_EQ(frame.record.status, FrameStatus::kComplete) << format.name;
        EXPECT_EQ(frame.payload, ramp(size, 7)) << format.name;
    }
}

TEST(V4l2SettingsTest, RefusesFramesInSeveralMemoryPlanes) {
    EmulatedDriver driver;
    driver.multi_planar = true;
    driver.memory_planes = 2;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<InputError>({}),
                HasSubstr("PixelFormat: the device sends Mono8 in 2 memory "
                          "planes"));
}

TEST(V4l2SettingsTest, RefusesAFormatThatTheDriverWouldReplace) {
    EmulatedV4l2 emulated;  // GREY only
    EXPECT_THAT(error_of<InputError>({{"PixelFormat", "Mono16"}}),
                HasSubstr("would send GREY instead of Mono16; it has Mono8"));
}

TEST(V4l2SettingsTest, RefusesFormatsThatAreNotRaw) {
    EmulatedDriver driver;
    driver.formats = {V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY};
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<InputError>({}),
                HasSubstr("set to YUYV, which is not read here; it has Mono8"));
    EXPECT_THAT(error_of<InputError>({{"PixelFormat", "YUYV"}}),
                HasSubstr("\"YUYV\" is not a format"));
}

TEST(V4l2SettingsTest, RefusesASizeThatTheDriverWouldReplace) {
    EmulatedV4l2 emulated;
    EXPECT_THAT(error_of<InputError>({{"Width", "640"}}),
                HasSubstr("would send 16 x 8 pixels instead of 640 x 8"));
}

TEST(V4l2SettingsTest, TakesTheSizeAskedFor) {
    EmulatedDriver driver;
    driver.any_size = true;
    EmulatedV4l2 emulated(driver);
    const auto camera = open_emulated({{"Width", "12"}, {"Height", "4"}});
    EXPECT_EQ(camera->layout().width, 12);
    EXPECT_EQ(camera->layout().height, 4);
    EXPECT_EQ(camera->layout().payload_bytes(), 48);
}

TEST(V4l2SettingsTest, RefusesSizesThatAreNone) {
    EmulatedV4l2 emulated;
    for (const char* const text : {"0", "-1", "65536", "99999999999999999999", "1e3", "", "8 "})
        EXPECT_THAT(error_of<InputError>({{"Width", text}}), HasSubstr("Width: \"")) << text;
}

TEST(V4l2SettingsTest, PlacesTheRegion) {
    EmulatedDriver driver;
    driver.any_size = driver.selections = true;
    driver.region = {0, 0, 16, 8};
    EmulatedV4l2 emulated(driver);
    const auto camera =
        open_emulated({{"Width", "8"}, {"Height", "4"}, {"OffsetX", "4"}, {"OffsetY", "2"}});
    EXPECT_EQ(camera->layout().offset_x, 4);
    EXPECT_EQ(camera->layout().offset_y, 2);
    EXPECT_EQ(camera->description().transport_facts.at("crop"), "8x4+4+2");
    EXPECT_THAT(error_of<InputError>({{"OffsetX", "3"}}),  // even places only
                HasSubstr("does not put 8 x 4 pixels at (3, 0)"));
}

TEST(V4l2SettingsTest, RefusesARegionWhereThereIsNone) {
    EmulatedV4l2 emulated;
    EXPECT_THAT(error_of<InputError>({{"OffsetX", "4"}}), HasSubstr("cannot choose a region"));
}

TEST(V4l2SettingsTest, SetsTheRateAndRefusesAnotherOne) {
    EmulatedV4l2 emulated;
    const auto camera = open_emulated({{"AcquisitionFrameRate", "29.97"}});
    EXPECT_EQ(camera->description().features.at("AcquisitionFrameRate"), "29.97");
    EXPECT_THAT(error_of<InputError>({{"AcquisitionFrameRate", "200"}}),
                HasSubstr("would send 60 frames/s instead of 200"));
    for (const char* const text : {"0", "-5", "nan", "inf", "fast"})
        EXPECT_THAT(error_of<InputError>({{"AcquisitionFrameRate", text}}),
                    HasSubstr("AcquisitionFrameRate: \""));
}

TEST(V4l2SettingsTest, RefusesARateThatCannotBeSet) {
    EmulatedDriver driver;
    driver.rates = false;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<InputError>({{"AcquisitionFrameRate", "30"}}),
                HasSubstr("does not let itself be told a rate"));
    EXPECT_EQ(open_emulated()->description().features.count("AcquisitionFrameRate"), 0);
}

TEST(V4l2SettingsTest, RefusesInterlacedFields) {
    EmulatedDriver driver;
    driver.field = V4L2_FIELD_INTERLACED;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<InputError>({}), HasSubstr("interlaced"));
}

TEST(V4l2SettingsTest, RefusesAnswersThatDoNotFitTogether) {
    EmulatedDriver driver;
    driver.formats = {V4L2_PIX_FMT_Y16};  // of which a row of 16 has 32 bytes
    driver.bits_per_pixel = 8;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<DeviceError>({}), HasSubstr("too few for 16 x 8 pixels of Mono16"));
}

TEST(V4l2SettingsTest, SetsControlsByName) {
    EmulatedV4l2 emulated(driver_with_controls());
    const auto camera = open_emulated(
        {{"brightness", "130"}, {"gain_automatic", "0"}, {"exposure_auto", "Manual Mode"}});
    EXPECT_EQ(emulated.control(V4L2_CID_BRIGHTNESS), 130);
    EXPECT_EQ(emulated.control(V4L2_CID_AUTOGAIN), 0);
    EXPECT_EQ(emulated.control(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    const auto features = camera->description().features;
    EXPECT_EQ(features.at("brightness"), "130");
    EXPECT_EQ(features.at("exposure_auto"), "Manual Mode");
    EXPECT_EQ(features.at("exposure_time_absolute"), "157");
}

TEST(V4l2SettingsTest, ExposureTimeIsInMicrosecondsAndManual) {
    EmulatedV4l2 emulated(driver_with_controls());
    const auto camera = open_emulated({{"ExposureTime", "2500"}, {"gain_automatic", "0"}});
    EXPECT_EQ(emulated.control(V4L2_CID_EXPOSURE_ABSOLUTE), 25);
    EXPECT_EQ(emulated.control(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
    emulated.push(ramp_frame(128, 0));
    camera->start();
    const FrameRecord record = frame_from(*camera).record;
    EXPECT_EQ(record.exposure_us, 2500.0);
    EXPECT_EQ(record.gain, 5.0);
    EXPECT_FALSE(record.black_level_dn.has_value());
}

TEST(V4l2SettingsTest, DoesNotStateAnExposureThatTheCameraVaries) {
    EmulatedV4l2 emulated(driver_with_controls());  // automatic gain and exposure
    emulated.push(ramp_frame(128, 0));
    const auto camera = open_emulated();
    camera->start();
    const FrameRecord record = frame_from(*camera).record;
    EXPECT_FALSE(record.exposure_us.has_value());
    EXPECT_FALSE(record.gain.has_value());
}

TEST(V4l2SettingsTest, RefusesControlsAndValuesThatAreNone) {
    EmulatedV4l2 emulated(driver_with_controls());
    const std::vector<std::pair<std::pair<const char*, const char*>, const char*>> cases{
        {{"contrast", "1"},
         "contrast: the device has no such setting; its controls are brightness"},
        {{"brightness", "256"}, "brightness: \"256\" is not a whole number from 0 to 255"},
        {{"brightness", "12"}, "brightness: \"12\" is not 0 plus a multiple of 5"},
        {{"brightness", "bright"}, "brightness: \"bright\" is not a whole number"},
        {{"exposure_auto", "2"}, "\"2\" is none of 1 (Manual Mode), 3 (Aperture Priority Mode)"},
        {{"ExposureTime", "2550"}, "the device counts in 100 us"},
        {{"ExposureTime", "1e9"}, "is not a number from 100 to 500000 us"}};
    for (const auto& [setting, message] : cases)
        EXPECT_THAT(error_of<InputError>({{setting.first, setting.second}}), HasSubstr(message));
}

TEST(V4l2SettingsTest, RefusesNodesThatAreNoCamera) {
    EmulatedDriver driver;
    driver.capabilities = V4L2_CAP_READWRITE;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<DeviceError>({}), HasSubstr("cannot be used"));
    EXPECT_THROW(static_cast<void>(open_v4l2_camera("v4l2:/dev/video7", {}, {})), DeviceError);
    EXPECT_THROW(static_cast<void>(open_v4l2_camera("v4l2:7", {}, {})), DeviceError);
    EXPECT_THROW(static_cast<void>(open_v4l2_camera("v4l2:", {}, {})), InputError);
    EXPECT_THROW(static_cast<void>(open_v4l2_camera("v4l2:video0", {}, {})), InputError);
}

TEST(V4l2SettingsTest, RefusesBuffersThatCannotBe) {
    EmulatedDriver driver;
    driver.user_memory = false;
    driver.max_buffers = 1;
    EmulatedV4l2 emulated(driver);
    EXPECT_THAT(error_of<InputError>({}, 1), HasSubstr("take 2 to 1024"));
    EXPECT_THAT(error_of<InputError>({{"BufferMemory", "mine"}}), HasSubstr("neither driver nor"));
    EXPECT_THAT(error_of<DeviceError>({{"BufferMemory", "own"}}), HasSubstr("no memory of ours"));
    EXPECT_THAT(error_of<DeviceError>({}), HasSubstr("at least 2 are needed"));
    emulated.fail(VIDIOC_REQBUFS, {EBUSY});
    EXPECT_THAT(error_of<DeviceError>({}), HasSubstr("another program streams from it"));
}

TEST(V4l2FeaturesTest, ControlsAreDescribedWithUnitRangeChoicesAndAccess) {
    EmulatedDriver driver = driver_with_controls();
    driver.controls[2].about.flags = V4L2_CTRL_FLAG_INACTIVE;
    const EmulatedV4l2 emulated(driver);
    std::map<std::string, CameraFeature> features;
    for (const CameraFeature& feature : v4l2_features("v4l2:/dev/video0"))
        features[feature.name] = feature;
    ASSERT_EQ(features.size(), 5U);
    const CameraFeature& brightness = features["brightness"];
    EXPECT_EQ(brightness.type, "integer");
    EXPECT_EQ(brightness.access, "rw");
    EXPECT_EQ(brightness.value, "128");
    EXPECT_EQ(brightness.minimum, "0");
    EXPECT_EQ(brightness.maximum, "255");
    EXPECT_EQ(brightness.increment, "5");
    EXPECT_EQ(features["gain"].access, "ro");
    EXPECT_EQ(features["gain_automatic"].type, "boolean");
    EXPECT_EQ(features["exposure_auto"].value, "Aperture Priority Mode");
    EXPECT_EQ(features["exposure_auto"].choices,
              (std::vector<std::string>{"Manual Mode", "Aperture Priority Mode"}));
    EXPECT_FALSE(features["exposure_auto"].minimum.has_value());
    EXPECT_EQ(features["exposure_time_absolute"].unit, "100 us");
    EXPECT_THROW(static_cast<void>(v4l2_features("v4l2:video0")), InputError);
}

}  // namespace
}  // namespace stipple
