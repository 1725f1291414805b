#include "study/report/report_videos.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "study/report/report_page.h"
#include "tests/study/report/recorded_clip.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 16, .cols = 20, .planes = 3};
constexpr PixelArea kArea{.first_row = 2, .first_col = 3, .rows = 5, .cols = 7};
constexpr int kSlots = 6;
constexpr QualityOptions kQuality{.margin = 1, .max_value = 2};

/// The truth and a video that is 10 % brighter.
struct TwoVideos {
    TwoVideos()
        : truth(ramp(kSlots, kShape)), brighter(truth), videos(kShape, kArea, kQuality, &truth) {
        for (float& light : brighter.data()) light *= 1.1F;
        for (const FluxVideo* video : {&truth, &brighter}) {
            const std::size_t number = videos.add({"name", "text", 4});
            for (int slot = 0; slot < kSlots; ++slot) videos.put(number, slot, video->frame(slot));
        }
    }
    FluxVideo truth;
    FluxVideo brighter;
    ReportVideos videos;
};

TEST(ReportVideosTest, QualityIsThatOfTheMeterOverallAndByFrame) {
    TwoVideos two;
    const auto json = two.videos.json();
    EXPECT_TRUE(json[0]["quality"].is_null());  // the truth itself
    QualityMeter all(kShape, kQuality);
    for (int slot = 0; slot < kSlots; ++slot) {
        all.add(two.brighter.frame(slot), two.truth.frame(slot));
        QualityMeter one(kShape, {.max_value = 2});
        one.add(two.brighter.frame(slot), two.truth.frame(slot));
        const auto& frames = json[1]["quality"]["frames"];
        EXPECT_EQ(frames["psnr_db"][static_cast<std::size_t>(slot)], one.quality().psnr_db);
        EXPECT_EQ(frames["pu21_psnr_db"][static_cast<std::size_t>(slot)],
                  one.quality().pu21_psnr_db);
        EXPECT_EQ(frames["ssim"][static_cast<std::size_t>(slot)], one.quality().ssim);
    }
    EXPECT_EQ(json[1]["quality"]["psnr_db"], all.quality().psnr_db);
    EXPECT_EQ(json[1]["quality"]["ssim"], all.quality().ssim);
    EXPECT_EQ(json[1]["run"], 4);
}

TEST(ReportVideosTest, PicturesAreTheLightOfTheArea) {
    TwoVideos two;
    const auto planes = two.videos.take_planes();
    ASSERT_EQ(planes.size(), 2U * kSlots);
    EXPECT_EQ(planes[0].id, "v0-0");
    EXPECT_EQ(planes[2 * kSlots - 1].id, "v1-5");
    std::vector<std::uint16_t> codes;
    for (const float light : cropped(two.brighter.frame(5), kShape, kArea))
        codes.push_back(light_code(light));
    EXPECT_EQ(unpacked_plane(planes[2 * kSlots - 1].text), codes);
}

TEST(ReportVideosTest, PicturesOfSlotsCanBeLeftOut) {
    TwoVideos two;
    const std::size_t all = two.videos.bytes();
    two.videos.halve();
    two.videos.halve();
    EXPECT_EQ(two.videos.step(), 4);
    EXPECT_LT(two.videos.bytes(), all / 2);
    const auto planes = two.videos.take_planes();
    std::vector<std::string> ids;
    for (const PackedPlane& plane : planes) ids.push_back(plane.id);
    EXPECT_EQ(ids, (std::vector<std::string>{"v0-0", "v0-4", "v1-0", "v1-4"}));
    EXPECT_EQ(two.videos.json()[1]["quality"]["frames"]["ssim"].size(), kSlots);
}

TEST(ReportVideosTest, APictureThatEqualsTheOneBeforeIsAReference) {
    ReportVideos videos(kShape, kArea, kQuality, nullptr);
    const FluxVideo video = ramp(2, kShape);
    videos.add({"a"});
    for (const int slot : {0, 1, 2, 3}) videos.put(0, slot, video.frame(slot == 3 ? 1 : 0));
    const std::size_t bytes = videos.bytes();
    const auto planes = videos.take_planes();
    EXPECT_EQ(planes[1].text, "=v0-0");
    EXPECT_EQ(planes[2].text, "=v0-0");
    EXPECT_EQ(bytes, planes[0].text.size() + planes[3].text.size() + 4 * kPlaneTagBytes);
}

TEST(ReportVideosTest, WithoutATruthThereIsNoQuality) {
    ReportVideos videos(kShape, kArea, kQuality, nullptr);
    const FluxVideo video = ramp(1, kShape);
    videos.put(videos.add({"a"}), 0, video.frame(0));
    EXPECT_TRUE(videos.json()[0]["quality"].is_null());
    EXPECT_TRUE(videos.json()[0]["run"].is_null());
}

}  // namespace
}  // namespace stipple
