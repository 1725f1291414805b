#include "study/report/stream_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "decoder/reconstruct.h"
#include "stream/stream_reader.h"
#include "tests/study/report/recorded_clip.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 24, .planes = 3};
constexpr int kSlots = 12;

FluxVideo naive_video(const std::filesystem::path& stream, const std::string& /*options*/) {
    StreamReader reader(stream);
    FluxVideo video(kSlots, kShape);
    decode(reader, DecodeMethod::kNaive, [&](std::int64_t slot, std::span<const float> frame) {
        std::ranges::copy(frame, video.frame(static_cast<int>(slot)).begin());
        return true;
    });
    return video;
}

class StreamReportTest : public testing::Test {
  protected:
    StreamReportTest() { record_clip(folder_ / "a.stipple", {}, light_); }

    [[nodiscard]] StreamReportTask task_of(const OwnDecoder& decoder) {
        StreamReportTask task;
        task.runs.push_back((folder_ / "a.stipple").string());
        task.output = folder_ / "a.html";
        task.truth.emplace();
        task.truth->name = "light";
        task.truth->shape = kShape;
        task.truth->next = [this, slot = 0]() mutable -> std::span<const float> {
            if (slot == kSlots) return {};
            return light_.frame(slot++);
        };
        task.methods = {decoder};
        return task;
    }
    [[nodiscard]] static StreamReportResult made(const StreamReportTask& task) {
        return report_streams(
            task, {.check = [] {},
                   .begin = [](const auto&, auto) { return [](double) { return true; }; }});
    }

    const TemporaryFolder folder_;
    FluxVideo light_ = ramp(kSlots, kShape);
};

TEST_F(StreamReportTest, AnOwnDecoderStandsBesideNaive) {
    const StreamReportResult result = made(task_of({"own", naive_video}));
    const auto figures = nlohmann::json::parse(result.figures);
    ASSERT_EQ(figures["videos"].size(), 3);
    EXPECT_EQ(figures["videos"][2]["name"], "a, own");
    EXPECT_EQ(figures["videos"][2]["quality"], figures["videos"][1]["quality"]);
    EXPECT_EQ(result.bytes, std::filesystem::file_size(folder_ / "a.html"));
}

TEST_F(StreamReportTest, AResultThatIsNoVideoOfTheStreamLeavesNoPage) {
    const OwnDecoder empty{"own", [](const auto&, const auto&) { return FluxVideo(1, kShape); }};
    EXPECT_THROW(static_cast<void>(made(task_of(empty))), DecoderFault);
    EXPECT_THROW(static_cast<void>(made(task_of({"best", naive_video}))), InputError);
    EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.stipple"});
}

}  // namespace
}  // namespace stipple
