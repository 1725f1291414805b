#include "study/report/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace stipple {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

const std::string kHostile =
    "</script><script>alert(1)</script><img src=x onerror='a' b=\"c\">&amp;";

/// The text between two others.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const auto from = text.find(begin) + begin.size();
    return text.substr(from, text.find(end, from) - from);
}

TEST(ReportPageTest, DataCannotEndTheirElement) {
    const ordered_json data{{"name", kHostile}, {kHostile, 1}};
    const std::string text = script_json(data);
    EXPECT_EQ(text.find_first_of("<>&"), std::string::npos) << text;
    EXPECT_EQ(ordered_json::parse(text), data);
}

TEST(ReportPageTest, BytesThatAreNoTextDoNotStopThePage) {
    EXPECT_EQ(ordered_json::parse(script_json({{"name", "a\xff"}}))["name"], "a\xef\xbf\xbd");
}

TEST(ReportPageTest, TextsAreEscaped) {
    EXPECT_EQ(html_text("a<b> & \"c\""), "a&lt;b&gt; &amp; &quot;c&quot;");
    EXPECT_EQ(html_text(kHostile).find_first_of("<>\""), std::string::npos);
}

TEST(ReportPageTest, ThePageHoldsTitleDataAndPlanes) {
    const ordered_json data{{"title", kHostile}, {"marks", "@PLANES@ @PROGRAM@"}};
    const std::string page = report_page(kHostile, data, {{"v0-1", "QUJD"}, {"r0k-2", "REVG"}});
    EXPECT_THAT(page, Not(HasSubstr("alert(1)</script>")));
    EXPECT_EQ(between(page, "<title>", "</title>"), html_text(kHostile));
    EXPECT_EQ(ordered_json::parse(between(page, "id=\"data\">", "</script>")), data);
    EXPECT_EQ(between(page, "id=\"v0-1\">", "</script>"), "QUJD");
    EXPECT_EQ(between(page, "id=\"r0k-2\">", "</script>"), "REVG");
}

TEST(ReportPageTest, AMarkInATextStaysAText) {
    const std::string page = report_page("@DATA@", {{"a", "@PROGRAM@"}}, {});
    EXPECT_EQ(between(page, "<title>", "</title>"), "@DATA@");
    EXPECT_EQ(between(page, "id=\"data\">", "</script>"), R"({"a":"@PROGRAM@"})");
}

TEST(ReportPageTest, NothingIsLoadedFromElsewhere) {
    const std::string page = report_page("a", {}, {});
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    for (const char* reference : {" src=", "@import", "url(", "href=\"http"})
        EXPECT_THAT(between(page, "<!DOCTYPE", "<script>"), Not(HasSubstr(reference)));
}

}  // namespace
}  // namespace stipple
