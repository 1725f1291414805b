#include <algorithm>
#include <array>

#include "study/scenes/embedded_scenes.h"
#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr Vec2 kShelfCorner{0.24F, -0.40F};  // upper left; it runs out of the image
constexpr float kShelfPitch = 0.205F;
constexpr float kBoard = 0.016F;
constexpr float kBookCell = 0.034F;
constexpr Vec2 kPot{-0.02F, 0.33F};

constexpr std::array<Rgb, 8> kCloth{{{0.42F, 0.07F, 0.05F},
                                     {0.07F, 0.17F, 0.32F},
                                     {0.10F, 0.24F, 0.12F},
                                     {0.62F, 0.50F, 0.30F},
                                     {0.26F, 0.13F, 0.07F},
                                     {0.70F, 0.66F, 0.58F},
                                     {0.50F, 0.30F, 0.06F},
                                     {0.05F, 0.05F, 0.06F}}};

}  // namespace

std::optional<Rgb> StillScene::shelf(Vec2 point) const noexcept {
    const Vec2 p = point - kShelfCorner;
    if (p.x < -kBoard || p.y < -kBoard) return {};
    const float grain = textures_->coarse.at(0.2F * point.x, 1.5F * point.y);
    const float row = p.y / kShelfPitch;
    const float up = (1 - fraction(row)) * kShelfPitch;  // above the board below
    if (p.x < 0 || p.y < 0 || up < kBoard)
        return (1 + 0.2F * grain) * (up > kBoard - 0.002F ? 1.3F : 1.0F) * Rgb{0.36F, 0.22F, 0.12F};
    return books(floor_int(row), {p.x, up - kBoard});
}

/// The reflectance of a row of books; gaps between them reflect next to nothing.
Rgb StillScene::books(int row, Vec2 in_row) const noexcept {
    const int index = floor_int(in_row.x / kBookCell);
    const auto item = static_cast<std::uint32_t>(row * 64 + (index & 63));
    const auto draw = [&](float low, float high, std::uint32_t field) {
        return textures_->random.between(low, high, item, 0x50000U + field);
    };
    const float under_board = smooth_step(0.0F, 0.06F, kShelfPitch - kBoard - in_row.y);
    const float grain = textures_->coarse.at(in_row.x + 0.3F * static_cast<float>(row), in_row.y);
    const Rgb back = (0.004F * (1 + 0.3F * grain)) * Rgb{1, 0.8F, 0.65F};
    const float across = fraction(in_row.x / kBookCell) - 0.5F;
    const float half = draw(0.36F, 0.5F, 1);
    const bool gap = (index + 2 * row) % 7 >= 5;
    if (gap || in_row.y > draw(0.11F, 0.165F, 2) || std::abs(across) > half) return back;
    const Rgb cloth = kCloth[static_cast<std::size_t>(draw(0, 7.999F, 3))];
    const float round = 1 - 0.75F * square(across / half);
    const float bands = draw(0.02F, 0.05F, 4);
    const float label = draw(0.075F, 0.095F, 5);
    if (std::abs(in_row.y - bands) < 0.0017F || std::abs(in_row.y - bands - 0.008F) < 0.0017F)
        return round * Rgb{0.75F, 0.58F, 0.25F};
    if (std::abs(in_row.y - label) < 0.016F && std::abs(across) < 0.7F * half) {
        const bool text = fraction(in_row.y / 0.0065F) < 0.45F && std::abs(across) < 0.5F * half;
        return round * (text ? Rgb{0.10F, 0.08F, 0.06F} : Rgb{0.66F, 0.60F, 0.46F});
    }
    return (under_board * 0.75F + 0.25F) * round * (1 + 0.15F * grain) * cloth;
}

Rgb StillScene::Instant::table(Vec2 point) const noexcept {
    const float down = point.y - kTableEdge;
    const Vec2 boards{point.x / (1 + 0.9F * down), 0.8F * down / (1 + 0.9F * down)};
    const Rgb board = planks(*scene->textures_, {boards.y + 5.02F, boards.x}, 0.12F);
    // Sun through the panes, and the panes' own reflection in the polish.
    const float lean = point.x + 0.30F - 0.55F * down;
    const float in =
        std::max(std::abs(lean) - 0.17F - 0.3F * down, std::abs(down - 0.12F) - 0.085F);
    const float bars = smooth_step(0.006F, 0.014F, std::abs(lean)) *
                       smooth_step(0.005F, 0.012F, std::abs(down - 0.10F));
    const float sun = smooth_step(0.008F, -0.008F, in) * bars;
    const Vec2 from_pot{point.x - kPot.x - 0.05F, (point.y - kPot.y - 0.075F) * 2.6F};
    const float shade = 1 - 0.8F * light_pool(dot(from_pot, from_pot), 0.09F);
    const float lip = down < 0.004F ? 1.5F : 1.0F;
    const Rgb light = room_light({point.x, kTableEdge - down}) + 0.9F * sun * Rgb{1, 0.92F, 0.74F};
    return 1.25F * lip * shade * (board * light) +
           0.05F * smooth_step(0.22F, 0.10F, std::abs(point.x + 0.3F)) * Rgb{0.85F, 0.92F, 1.0F};
}

std::optional<Rgb> StillScene::Instant::plant(Vec2 point) const noexcept {
    const Vec2 p = point - kPot;
    const float grain = scene->textures_->coarse.at(2 * point.x, 2 * point.y);
    // A glazed pot, lit by the window on its left.
    const float half = 0.062F - 0.18F * std::max(0.0F, p.y - 0.01F);
    if (p.y > -0.012F && p.y < 0.085F && std::abs(p.x) < half + (p.y < 0.008F ? 0.006F : 0.0F)) {
        const float across = p.x / half;
        const float light = 0.06F + 0.36F * square(clamp01(0.75F - 0.6F * across));
        const Vec2 glint{across + 0.55F, (p.y - 0.03F) / 0.062F};
        const bool band = std::abs(p.y - 0.045F) < 0.004F;
        return light * (1 + 0.08F * grain) *
                   (band ? Rgb{0.80F, 0.72F, 0.50F} : Rgb{0.16F, 0.34F, 0.50F}) +
               3.0F * light_pool(square(1.6F * glint.x) + square(0.6F * glint.y), 0.10F) *
                   Rgb{0.95F, 1.0F, 1.0F};
    }
    if (p.y > 0 || p.y < -0.36F || std::abs(p.x) > 0.24F) return {};
    for (int leaf = 0; leaf < 9; ++leaf) {  // long leaves that bend outwards and sway
        const float lean =
            0.25F * static_cast<float>(leaf - 4) + 0.06F * static_cast<float>(leaf * 5 % 3);
        const float length = 0.33F - 0.022F * static_cast<float>((leaf * 7 + 2) % 5);
        const float rise = -p.y / length;
        if (rise > 1) continue;
        const float bend =
            (0.55F * lean + 6 * leaf_turn * (0.7F + 0.1F * static_cast<float>(leaf % 4))) * rise *
            rise * length;
        const float across = p.x - 0.03F * lean - 0.22F * lean * rise * length - bend;
        const float half_width =
            0.0115F * (1 - rise * rise) * (0.35F + 1.3F * std::min(rise, 0.5F));
        if (std::abs(across) > half_width) continue;
        const bool vein = std::abs(across) < 0.0012F;
        const float light =
            (0.10F + 0.30F * rise) * (lean < 0 ? 1.2F : 0.75F) * (across < 0 ? 1.25F : 0.7F);
        return (vein ? 1.5F : 1.0F) * light * (1 + 0.15F * grain) * Rgb{0.32F, 0.62F, 0.14F};
    }
    return {};
}

}  // namespace stipple
