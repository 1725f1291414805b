#include <gtest/gtest.h>

#include <cstdlib>

#include "core/config.h"
#include "core/error.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

class FindConfigTest : public testing::Test {
  protected:
    FindConfigTest() {
        fs::create_directories(folder_ / "sensors");
        write_text(folder_ / "sensors/tiny.toml", "");
        write_text(folder_ / "sensors/notes.txt", "");
        setenv("STIPPLE_CONFIG_DIR", folder_.path().c_str(), 1);
    }
    ~FindConfigTest() override { unsetenv("STIPPLE_CONFIG_DIR"); }

    TemporaryFolder folder_;
};

TEST_F(FindConfigTest, FindsANameInTheFolderOfItsKind) {
    EXPECT_EQ(find_config(ConfigKind::kSensors, "tiny"), folder_ / "sensors/tiny.toml");
}

TEST_F(FindConfigTest, TakesAPathAsItIs) {
    const auto path = (folder_ / "sensors/tiny.toml").string();
    EXPECT_EQ(find_config(ConfigKind::kSchedules, path), path);
}

TEST_F(FindConfigTest, RefusesAMissingPath) {
    for (const char* name : {"no.toml", "no/tiny", "/no/tiny.toml"})
        expect_parts(
            message_of<InputError>([&] { return find_config(ConfigKind::kSensors, name); }),
            {std::string(name) + ": there is no such file"});
}

TEST_F(FindConfigTest, ListsTheKnownNames) {
    const auto message =
        message_of<InputError>([] { return find_config(ConfigKind::kSensors, "camera"); });
    expect_parts(message,
                 {"\"camera\": is neither a file nor one of the sensors; known are ", "tiny"});
    EXPECT_EQ(message.find("notes"), std::string::npos);
}

TEST_F(FindConfigTest, SuggestsWhatWasProbablyMeant) {
    expect_parts(message_of<InputError>([] { return find_config(ConfigKind::kSensors, "tinny"); }),
                 {"one of the sensors; did you mean \"tiny\"?"});
}

}  // namespace
}  // namespace stipple
