#include "readout/footage_origin.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

FootageOrigin origin_of_files(const std::filesystem::path& footage) {
    return origin_of(footage.string(), {}, [] {});
}

// FIPS 180-2, appendix B.1.
constexpr auto kHashOfAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

TEST(FootageOriginTest, HashIsThatOfTheFile) {
    const TemporaryFolder folder;
    std::ofstream(folder / "clip.npy") << "abc";
    const FootageOrigin origin = origin_of_files(folder / "clip.npy");
    EXPECT_EQ(origin.name, "clip.npy");
    EXPECT_EQ(origin.sha256, kHashOfAbc);
}

TEST(FootageOriginTest, FilesOfAFolderFollowEachOtherInTheOrderOfFrames) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "scene");
    std::ofstream(folder / "scene/frame_10.png") << "c";
    std::ofstream(folder / "scene/frame_2.png") << "b";
    std::ofstream(folder / "scene/frame_1.png") << "a";
    const FootageOrigin origin = origin_of_files(folder / "scene");
    EXPECT_EQ(origin.name, "scene");
    EXPECT_EQ(origin.sha256, kHashOfAbc);
    EXPECT_EQ(origin_of_files((folder / "scene").string() + "/").name, "scene");
}

TEST(FootageOriginTest, ItMayBeGivenUp) {
    const TemporaryFolder folder;
    std::ofstream(folder / "clip.npy") << "abc";
    EXPECT_THROW(static_cast<void>(origin_of((folder / "clip.npy").string(), {},
                                             [] { throw std::runtime_error("stop"); })),
                 std::runtime_error);
}

}  // namespace
}  // namespace stipple
