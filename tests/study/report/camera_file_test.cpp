#include "study/report/camera_file.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

TEST(CameraFileTest, HasTheKeysThatAReportShows) {
    const TemporaryFolder folder;
    const std::string file = (folder / "camera.json").string();
    write_text(file, R"({"measured": {"gain": 2}, "photon_transfer": [[1, 2, 3]],)"
                     R"( "saturation_point": 0, "seed": 5})");
    EXPECT_EQ(read_camera_file(file),
              R"({"measured":{"gain":2},"photon_transfer":[[1,2,3]],"saturation_point":0})");
    write_text(file, R"({"measured": {"gain": 2}, "photon_transfer": [], "saturation_point": 0})");
    EXPECT_THROW(static_cast<void>(read_camera_file(file)), InputError);
}

}  // namespace
}  // namespace stipple
