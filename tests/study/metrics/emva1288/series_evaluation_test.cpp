#include "study/metrics/emva1288/series_evaluation.h"

#include <gtest/gtest.h>

#include <map>

#include "core/error.h"

namespace stipple::emva1288 {
namespace {

/// Images of a camera with K = 1 DN/e: pairs differ by an amplitude that rises with their light.
class SeriesEvaluationTest : public ::testing::Test {
  protected:
    SeriesEvaluationTest() {
        add(0, 2);
        for (int level = 1; level <= 12; ++level) add(level, 2);
        add(6, 4);
        add(0, 4);
    }
    void add(int level, int images) {
        ImageGroup group{
            .exposure_ns = 1000, .photons = 100.0 * level, .dark = level == 0, .files = {}};
        ImageStack stack;
        for (int i = 0; i < images; ++i) {
            SeriesImage image{.rows = 2, .cols = 4, .dn = {}};
            for (int pixel = 0; pixel < 8; ++pixel)
                image.dn.push_back(static_cast<std::uint16_t>(
                    (level == 0 ? pixel % 2 : 10 + 100 * level) + (pixel + i) % 2 * (2 + level)));
            stack.add(image.dn);
            group.files.push_back("g" + std::to_string(series_.groups.size()) + "_" +
                                  std::to_string(i));
            images_["set/" + group.files.back()] = image;
        }
        series_.groups.push_back(group);
        statistics_.push_back(
            {.images = stack.statistics(), .zero_fraction = level == 0 ? 0.25 : 0});
    }
    Evaluation evaluated() {
        return evaluate(
            series_, "set",
            [this](const std::filesystem::path& file) { return images_.at(file.string()); },
            "set.txt");
    }
    std::string message() {
        try {
            static_cast<void>(evaluated());
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    }

    Series series_{.bits = 12, .cols = 4, .rows = 2, .groups = {}};
    std::vector<GroupStatistics> statistics_;
    std::map<std::string, SeriesImage> images_;
};

TEST_F(SeriesEvaluationTest, IsThatOfTheStatisticsOfItsImages) {
    const Evaluation found = evaluated();
    const Evaluation expected = evaluate(series_, statistics_, "set.txt");
    EXPECT_EQ(found.figures.gain_dn_per_e, expected.figures.gain_dn_per_e);
    EXPECT_EQ(found.figures.dark_noise_e, expected.figures.dark_noise_e);
    EXPECT_EQ(found.dark_mean_dn, expected.dark_mean_dn);
    EXPECT_EQ(found.dark_zero_fraction, 0.25);
    EXPECT_EQ(found.transfer.size(), expected.transfer.size());
}

TEST_F(SeriesEvaluationTest, AnImageOfAnotherSizeIsNamed) {
    images_["set/g3_1"].rows = 4;
    EXPECT_EQ(message(), "set/g3_1: is 4 x 4, but the descriptor says 4 x 2");
}

TEST_F(SeriesEvaluationTest, AnImageWithMoreBitsIsNamed) {
    images_["set/g3_1"].dn[5] = 4096;
    EXPECT_EQ(message(), "set/g3_1: holds the DN 4096, but the descriptor says 12 bits");
}

}  // namespace
}  // namespace stipple::emva1288
