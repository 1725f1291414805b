// Chips with a tile of unequal pixels, of one plane, of three, and behind a mosaic of colours.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "calibration/chip_estimate.h"
#include "core/colour_filter.h"
#include "core/index.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

constexpr double kFlatSeconds = 0.005;
constexpr double kFlatLight[] = {8e6, 5.6e6, 3.2e6};  ///< of each colour, in DN/s
constexpr double kPrnu[] = {0.02, 0.03, 0.04};        ///< of each plane, as the next three
constexpr double kBlackDn[] = {500, 510, 540};
constexpr double kDarkDnPerS[] = {100, 200, 600};
constexpr double kNoiseDn[] = {1, 2, 3};
constexpr double kDsnuDn = 20;
constexpr int kFrames = 8;

/// A tile of 2 x 3 pixels, not that of the mosaics.
StreamHeader header_of(int planes, ColourFilter cfa, double seconds) {
    return {.shape = {.rows = 36, .cols = 48, .planes = planes},
            .slot_us = seconds * 1e6,
            .calibration = {.bit_depth = 16,
                            .black_level_dn = 500,
                            .gain_e_per_dn = 1,
                            .full_well_e = 1e6,
                            .electrons_per_unit = 1000,
                            .tile = {2,
                                     3,
                                     {{1, 1}, {0.5, 1}, {0.5, 2}, {0.25, 2}, {0.8, 1}, {1, 0.3}}}},
            .schedule = {1, 1, 1, {0, 1}, {{0, 1}}},
            .schedule_source = {},
            .schedule_name = "",
            .provenance = "",
            .cfa = cfa};
}

/// y = offset + dark t + (responsivity x conversion gain of the tile) x gain x light t, in DN.
class TileChip {
  public:
    TileChip(int planes, ColourFilter cfa) : header_(header_of(planes, cfa, kFlatSeconds)) {
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        for (std::size_t i = 0; i < header_.shape.sites(); ++i) {
            gain_.push_back(1 + kPrnu[plane_of(i)] * normal(random));
            offset_.push_back(kBlackDn[plane_of(i)] + kDsnuDn * normal(random));
        }
        // Of mean 1 for each pixel of the tile and each colour.
        const std::vector<double> means = means_of_kinds(gain_);
        for (std::size_t i = 0; i < gain_.size(); ++i) gain_[i] /= means[kind_of(i)];
    }

    [[nodiscard]] std::size_t plane_of(std::size_t site) const {
        return site / header_.shape.pixels();
    }
    [[nodiscard]] int row_of(std::size_t site) const {
        return static_cast<int>(site % header_.shape.pixels()) / header_.shape.cols;
    }
    [[nodiscard]] int col_of(std::size_t site) const {
        return static_cast<int>(site) % header_.shape.cols;
    }
    [[nodiscard]] std::size_t colour_of(std::size_t site) const {
        return header_.cfa == ColourFilter::kNone
                   ? plane_of(site)
                   : index(colour_plane(header_.cfa, row_of(site), col_of(site)));
    }
    [[nodiscard]] std::size_t kind_of(std::size_t site) const {
        return colour_of(site) * 6 + index(row_of(site) % 2 * 3 + col_of(site) % 3);
    }
    [[nodiscard]] const CalibrationPixel& pixel_of(std::size_t site) const {
        return header_.calibration.tile.pixels[kind_of(site) % 6];
    }
    /// Means of the sites of each kind; NaN for a kind without sites.
    [[nodiscard]] std::vector<double> means_of_kinds(const std::vector<double>& of_sites) const {
        std::vector<double> sum(18), count(18);
        for (std::size_t i = 0; i < of_sites.size(); ++i) {
            sum[kind_of(i)] += of_sites[i];
            ++count[kind_of(i)];
        }
        for (std::size_t kind = 0; kind < 18; ++kind) sum[kind] /= count[kind];
        return sum;
    }

    [[nodiscard]] ChipEstimate estimate() const {
        FieldSamples dark(header_.shape), flat(header_.shape);
        expose(kFlatSeconds, false, dark);
        expose(16 * kFlatSeconds, false, dark);
        expose(kFlatSeconds, true, flat);
        return estimate_chip({.header = header_, .dark = dark, .flats = {&flat, 1}});
    }
    /// A sample without noise, rounded.
    [[nodiscard]] double dn(std::size_t site, double seconds, bool lit) const {
        const CalibrationPixel& pixel = pixel_of(site);
        const double light =
            pixel.responsivity * pixel.conversion_gain * gain_[site] * kFlatLight[colour_of(site)];
        return std::round(offset_[site] +
                          seconds * (kDarkDnPerS[plane_of(site)] + (lit ? light : 0)));
    }

    [[nodiscard]] const StreamHeader& header() const { return header_; }
    [[nodiscard]] const std::vector<double>& gain() const { return gain_; }

  private:
    /// Noise that the mean of the frames does not keep: up and down by turns.
    void expose(double seconds, bool lit, FieldSamples& field) const {
        const FrameShape shape = header_.shape;
        const StreamHeader header = header_of(shape.planes, header_.cfa, seconds);
        FieldCollector collector(header, field);
        for (int frame = 0; frame < kFrames; ++frame) {
            SamplePacket packet{.slot = frame, .rows = shape.rows, .dn = {}};
            for (std::size_t pixel = 0; pixel < shape.pixels(); ++pixel)
                for (std::size_t plane = 0; plane < index(shape.planes); ++plane) {
                    const double noise = (pixel + index(frame)) % 2 == 0 ? 1 : -1;
                    packet.dn.push_back(static_cast<std::uint16_t>(
                        dn(plane * shape.pixels() + pixel, seconds, lit) +
                        noise * kNoiseDn[plane]));
                }
            collector.add(packet);
        }
    }

    StreamHeader header_;
    std::vector<double> gain_, offset_;
};

class ChipTileTest : public testing::TestWithParam<std::pair<int, ColourFilter>> {
  protected:
    const TileChip chip_{GetParam().first, GetParam().second};
    const ChipEstimate estimate_ = chip_.estimate();
    /// Half a DN of the offset and of the sample each, of 0.3 x 3.2e6 x 0.005 DN at least.
    /// Shrinking adds a tenth: noise of 3 DN in 16 frames beside a DSNU of 20 DN.
    static constexpr double kRounding = 1.1 / 4800;
};

TEST_P(ChipTileTest, GainsHaveNoneOfTheTileAndMeanOneForEachOfItsPixelsAndColours) {
    std::vector<double> gains;
    for (const SiteCalibration& site : estimate_.calibration.sites)
        gains.push_back(static_cast<double>(site.gain));
    for (std::size_t i = 0; i < gains.size(); ++i)
        ASSERT_NEAR(gains[i], chip_.gain()[i], kRounding) << i;
    for (const double mean : chip_.means_of_kinds(gains))
        EXPECT_TRUE(std::isnan(mean) || std::abs(mean - 1) < kRounding) << mean;
    EXPECT_EQ(estimate_.defects, 0U);
}

// The same light for all sites of a colour; 1 DN of charge is 1 / 1000 of a unit.
TEST_P(ChipTileTest, CalibratedPixelsTellTheLightThatTheySee) {
    const auto sites = chip_.header().shape.sites();
    for (std::size_t i = 0; i < sites; ++i) {
        const PixelResponse response(chip_.header().calibration, chip_.pixel_of(i),
                                     estimate_.calibration.sites[i], kFlatSeconds);
        const double light = kFlatLight[chip_.colour_of(i)] * kFlatSeconds / 1000;
        const auto dn = static_cast<std::uint16_t>(chip_.dn(i, kFlatSeconds, true));
        ASSERT_NEAR(static_cast<double>(response.light(dn, 1)), light, 2 * kRounding * light) << i;
    }
}

TEST_P(ChipTileTest, FiguresAreMeansOverThePlanes) {
    const int planes = chip_.header().shape.planes;
    double prnu2 = 0, black = 0, dark = 0, noise2 = 0;
    for (int plane = 0; plane < planes; ++plane) {
        const std::size_t i = index(plane);
        prnu2 += kPrnu[i] * kPrnu[i] / planes;
        black += kBlackDn[i] / planes;
        dark += kDarkDnPerS[i] / planes;
        noise2 += kNoiseDn[i] * kNoiseDn[i] * kFrames / (kFrames - 1) / planes;
    }
    // Five standard deviations of means over the sites, and of the mean of their squares.
    const double sites = static_cast<double>(chip_.header().shape.pixels());
    const double scatter = 5 / std::sqrt(sites);
    EXPECT_NEAR(estimate_.gain.mean, 1, kRounding);
    EXPECT_NEAR(estimate_.gain.pixels, prnu2, std::sqrt(2) * scatter * prnu2);
    EXPECT_NEAR(estimate_.offset_dn.mean, black, scatter * kDsnuDn);
    EXPECT_NEAR(std::sqrt(estimate_.offset_dn.pixels), kDsnuDn, scatter * kDsnuDn);
    EXPECT_NEAR(estimate_.dark_dn_per_s.mean, dark, scatter / 0.075);
    EXPECT_NEAR(estimate_.readout_noise_dn2.mean, noise2, 1e-9 * noise2);
}

INSTANTIATE_TEST_SUITE_P(PlanesAndMosaics, ChipTileTest,
                         testing::Values(std::pair{1, ColourFilter::kNone},
                                         std::pair{3, ColourFilter::kNone},
                                         std::pair{1, ColourFilter::kRggb}));

}  // namespace
}  // namespace stipple
