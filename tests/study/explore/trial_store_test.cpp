#include "study/explore/trial_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

TrialOutcome outcome() {
    return {{.slots_per_second = 2000,
             .limited_by = "link",
             .megabits_per_second = 0.1 + 0.2,  // of all digits
             .psnr_db = std::numeric_limits<double>::infinity(),
             .decode_seconds = 1e-300,
             .compared_slots = "4:28"},
            {.rows = 1, .cols = 4, .channels = 1, .bytes = {1, 2, 3, 4}}};
}

class TrialStoreTest : public testing::Test {
  protected:
    const TemporaryFolder folder_;
    const TrialStore store_{folder_.path() / "results"};
};

TEST_F(TrialStoreTest, FiguresComeBackAsTheyWere) {
    EXPECT_FALSE(store_.find("a"));
    store_.store("a", outcome());
    const auto found = store_.find("a");
    ASSERT_TRUE(found);
    const TrialFigures written = outcome().figures;
    for (const FigureColumn& column : kFigureColumns) {
        const double before = written.*column.value;
        const double after = (*found).*column.value;
        EXPECT_TRUE(before == after || (std::isnan(before) && std::isnan(after))) << column.name;
    }
    EXPECT_EQ(found->limited_by, "link");
    EXPECT_EQ(found->compared_slots, "4:28");
    EXPECT_FALSE(store_.find("b"));
}

TEST_F(TrialStoreTest, ThePictureIsAPngFile) {
    store_.store("a", outcome());
    const auto png = store_.picture(TrialStore::address_of("a"));
    const PngImage image = decode_png(png, "a");
    EXPECT_EQ(image.pixels.bytes, outcome().picture.bytes);
    EXPECT_TRUE(store_.picture(TrialStore::address_of("b")).empty());
}

TEST_F(TrialStoreTest, DamagedFilesAreUnknownTrials) {
    const fs::path file = store_.folder() / "trials" / (TrialStore::address_of("a") + ".json");
    for (const char* text :
         {"", "{", "[]", "{}", R"({"identity":"a"})", R"({"identity":"a","figures":3})",
          R"({"identity":"a","figures":{}})", R"({"identity":1,"figures":{"limited_by":"x"}})",
          R"({"identity":"a","figures":{"limited_by":"x","slots_per_second":[]}})"}) {
        std::ofstream(file) << text;
        EXPECT_FALSE(store_.find("a")) << text;
    }
    store_.store("a", outcome());
    EXPECT_TRUE(store_.find("a"));
}

TEST_F(TrialStoreTest, AnAddressIsTheHashOfTheIdentity) {
    // SHA-256 of "abc" of FIPS 180-2, its first 64 bits.
    EXPECT_EQ(TrialStore::address_of("abc"), "ba7816bf8f01cfea");
}

TEST_F(TrialStoreTest, AnotherVersionOrFolderIsRefused) {
    std::ofstream(store_.folder() / "version.txt") << "0.0.1\n";
    EXPECT_THROW(TrialStore(store_.folder()), InputError);
    fs::remove(store_.folder() / "version.txt");
    EXPECT_THROW(TrialStore(store_.folder()), InputError);  // it has the folder trials
    std::ofstream(folder_.path() / "file") << "a";
    EXPECT_THROW(TrialStore(folder_.path() / "file"), InputError);
    EXPECT_THROW(TrialStore(folder_.path() / "no" / "such"), InputError);
    EXPECT_THROW(TrialStore(folder_.path() / "file" / "such"), InputError);
}

}  // namespace
}  // namespace stipple
