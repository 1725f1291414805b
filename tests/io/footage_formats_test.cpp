// What a new format of footage must not lack, beside its reader and its own tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>

#include "io/footage_formats.h"
#include "tests/support/source_tree.h"

namespace stipple {
namespace {

/// The first column of the table "What files declare" of docs/footage.md.
std::string declaring_files() {
    std::ifstream page(project_path("docs/footage.md"));
    std::string files, line;
    while (std::getline(page, line) && line != "| file | declaration | effect |") continue;
    while (std::getline(page, line) && line.starts_with('|'))
        files += line.substr(0, line.find('|', 1)) + "\n";
    return files;
}

TEST(FootageFormatsTest, EachHasDeclarationsInTheDocumentationAndAFuzzTarget) {
    const std::string files = declaring_files();
    ASSERT_FALSE(files.empty());
    for (const std::string_view name : footage_format_names()) {
        EXPECT_NE(files.find(name), std::string::npos) << name;
        std::string target(name.substr(name.starts_with('.') ? 1 : 0));
        std::ranges::transform(target, target.begin(),
                               [](unsigned char c) { return std::tolower(c); });
        EXPECT_TRUE(exists(project_path("tests/fuzz/" + target + "_fuzz.cpp"))) << name;
    }
}

}  // namespace
}  // namespace stipple
