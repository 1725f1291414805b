#include <gtest/gtest.h>
#include <unistd.h>

#include <limits>

#include "core/error.h"
#include "io/footage_reader.h"
#include "tests/io/npy_bytes.h"
#include "tests/io/test_images.h"
#include "tests/support/byte_edits.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;
using Floats = std::vector<float>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Bad footage is refused with a message and nothing else: whatever a library writes to stdout or
/// stderr meanwhile is a failure.
class FootageErrorsTest : public testing::Test {
  protected:
    static std::string error_of(const fs::path& source, FootageOptions options = {}) {
        testing::internal::CaptureStderr();
        testing::internal::CaptureStdout();
        const auto message = message_of<InputError>([&] { read_all(source, options); });
        EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "for " << source;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        return message;
    }
    std::string error_of_npy(std::string_view shape, const Floats& values,
                             FootageOptions options = {}) {
        write_text(folder_ / "clip.npy", npy_file("<f4", shape, bytes_of(values)));
        return error_of(folder_ / "clip.npy", options);
    }

    TemporaryFolder folder_;
};

TEST_F(FootageErrorsTest, NamesMissingFootage) {
    for (const char* name : {"no", "no.npy", "no.mp4", "no.png", "no/deeper.npy"})
        expect_parts(error_of(folder_ / name), {std::string(name) + ": there is no such file"});
    expect_parts(error_of(""), {"there is no such file"});
}

TEST_F(FootageErrorsTest, NamesAnEmptyFolder) {
    expect_parts(error_of(folder_.path()), {folder_.path().string(), "holds no PNG"});
}

TEST_F(FootageErrorsTest, NamesFilesOfUnknownKind) {
    write_text(folder_ / "notes.txt", "hello");
    expect_parts(error_of(folder_ / "notes.txt"),
                 {"notes.txt: is not a recognised footage format"});
}

TEST_F(FootageErrorsTest, NamesEmptyAndForeignFiles) {
    for (const char* name : {"a.png", "a.tiff", "a.exr", "a.npy", "a.mp4", "a.mkv", "a.avi"})
        for (const char* content : {"", "hello, this is not an image"}) {
            write_text(folder_ / name, content);
            expect_parts(error_of(folder_ / name), {name});
        }
}

TEST_F(FootageErrorsTest, NamesFoldersInPlaceOfFiles) {
    for (const char* name : {"a.npy", "a.mp4"}) {
        fs::create_directory(folder_ / name);
        expect_parts(error_of(folder_ / name), {"holds no PNG"});
    }
    fs::create_directories(folder_ / "frames/f1.png");
    expect_parts(error_of(folder_ / "frames"), {"f1.png: cannot be read", "directory"});
}

TEST_F(FootageErrorsTest, NamesUnreadableFiles) {
    fs::permissions(folder_.path(), fs::perms::others_exec, fs::perm_options::add);
    for (const char* name : {"a.npy", "a.png", "a.exr", "a.mp4"}) {
        write_text(folder_ / name, "x");
        fs::permissions(folder_ / name, fs::perms::none);
    }
    const uid_t user = geteuid();
    constexpr uid_t kNobody = 65534;
    ASSERT_EQ(seteuid(user == 0 ? kNobody : user), 0);  // the superuser may read everything
    for (const char* name : {"a.npy", "a.png", "a.exr", "a.mp4"})
        expect_parts(error_of(folder_ / name), {name});
    ASSERT_EQ(seteuid(user), 0);
}

TEST_F(FootageErrorsTest, NamesTheTruncatedImageWhateverItsLength) {
    for (const char* extension : {".png", ".tiff"}) {
        const fs::path second = folder_ / (std::string("f1") + extension);
        cv::Mat image(9, 7, CV_16UC3);
        cv::randu(image, 0, 65535);
        cv::imwrite((folder_ / (std::string("f0") + extension)).string(), image);
        cv::imwrite(second.string(), image);
        const std::string whole = read_text(second);
        for (std::size_t length = 0; length < whole.size(); length += 5) {
            write_text(second, whole.substr(0, length));
            expect_parts(error_of(folder_.path()), {second.string() + ": "});
        }
        fs::remove(second);
        fs::remove(folder_ / (std::string("f0") + extension));
    }
}

TEST_F(FootageErrorsTest, SaysWhereAPngIsDamaged) {
    write_flat(folder_ / "f.png", 4, 4, CV_8UC1, 100);
    const std::string png = read_text(folder_ / "f.png");
    for (std::size_t i = 0; i < png.size(); ++i) {
        write_text(folder_ / "f.png", flipped(png, i));
        expect_parts(error_of(folder_ / "f.png"), {i < 8 ? "is not a PNG" : "f.png: offset "});
    }
}

TEST_F(FootageErrorsTest, NamesATiffWithSeveralPagesAmongImages) {
    const std::vector<cv::Mat> pages(2, cv::Mat(2, 2, CV_8UC1, cv::Scalar(5)));
    cv::imwritemulti((folder_ / "f1.tiff").string(), pages);
    expect_parts(error_of(folder_.path()), {"f1.tiff: holds 2 images"});
}

TEST_F(FootageErrorsTest, NamesTheImageThatDiffersInSizeOrPlanes) {
    write_flat(folder_ / "f0.png", 4, 6, CV_8UC1, 1);
    write_flat(folder_ / "f1.png", 4, 5, CV_8UC1, 1);
    expect_parts(error_of(folder_.path()), {"f1.png: is 5 x 4 x 1", "6 x 4 x 1"});
    write_flat(folder_ / "f1.png", 4, 6, CV_8UC3, {1, 1, 1});
    expect_parts(error_of(folder_.path()), {"f1.png: is 6 x 4 x 3", "6 x 4 x 1"});
}

TEST_F(FootageErrorsTest, NamesFileFrameRowColumnAndPlaneOfBadLight) {
    Floats values(2 * 2 * 2 * 3, 1.0F);
    values[12 + 2 * 3 + 1] = -0.25F;  // frame 1, row 1, column 0, green
    expect_parts(error_of_npy("(2, 2, 2, 3)", values),
                 {"clip.npy: frame 1: row 1, column 0, plane 1: light is negative (-0.25); "
                  "clip it with min_value = 0"});
    EXPECT_NE(error_of_npy("(1, 1, 2)", {1, kNan}).find("row 0, column 1, plane 0: light is not"),
              std::string::npos);
    expect_parts(error_of_npy("(1, 1, 2)", {kInfinity, 1}), {"row 0, column 0", "is infinite"});
    expect_parts(error_of_npy("(1, 1, 1)", {-kInfinity}), {"is infinite (-inf)"});
}

TEST_F(FootageErrorsTest, NoOptionHidesBadLight) {
    for (const float bad : {kNan, kInfinity, -0.5F})
        for (const auto transfer : {Transfer::kLinear, Transfer::kGamma22, Transfer::kSrgb})
            expect_parts(error_of_npy("(1, 1, 1, 3)", {1, bad, 1}, {transfer, true, 2.0}),
                         {"clip.npy: frame 0: row 0, column 0, plane 1"});
    // Finite in the file, but not as light.
    expect_parts(
        error_of_npy("(1, 1, 1)", {1e30F}, {.transfer = Transfer::kGamma22, .max_value = {}}),
        {"is infinite"});
    write_text(folder_ / "big.npy", npy_file("<f8", "(1, 1, 1)", bytes_of(std::vector{1e300})));
    expect_parts(error_of(folder_ / "big.npy"), {"is infinite"});
}

TEST_F(FootageErrorsTest, NoticesAnNpyFileThatShrinksWhileItIsRead) {
    constexpr std::size_t kFrame = 100 * 100 * 4;
    write_text(folder_ / "clip.npy", npy_file("<f4", "(9, 100, 100)", std::string(9 * kFrame, 0)));
    FootageReader reader(folder_ / "clip.npy");
    Floats frame(kFrame / 4);
    EXPECT_TRUE(reader.read(frame));
    fs::resize_file(folder_ / "clip.npy", 5 * kFrame);
    expect_parts(message_of<InputError>([&] {
                     while (reader.read(frame)) {
                     }
                 }),
                 {"clip.npy: frame 4: ", "cut short"});
}

}  // namespace
}  // namespace stipple
