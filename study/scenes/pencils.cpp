#include "study/scenes/embedded_scenes.h"

#include <algorithm>
#include <bit>

#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr float kPixel = 1.0F / 240;  // speeds are in pixels of the default image
constexpr int kTileRows = 16;
constexpr float kTile = 1.0F / kTileRows;
constexpr float kMargin = 0.26F;  // longest half pencil and its shadow
constexpr Vec2 kShadowOffset{0.012F, 0.016F};
constexpr float kShadowBlur = 0.007F;
constexpr Vec3 kToSun{-0.50F, -0.58F, 0.643F};
constexpr Vec2 kCup{-0.40F, -0.24F};

constexpr std::array<Rgb, 9> kColours{{{0.72F, 0.05F, 0.03F},
                                       {0.85F, 0.48F, 0.03F},
                                       {0.85F, 0.70F, 0.06F},
                                       {0.06F, 0.36F, 0.09F},
                                       {0.03F, 0.20F, 0.55F},
                                       {0.02F, 0.42F, 0.50F},
                                       {0.36F, 0.06F, 0.34F},
                                       {0.75F, 0.72F, 0.66F},
                                       {0.03F, 0.03F, 0.035F}}};

/// Distance to a stick (negative inside), local = (along, across) from its centre.
float stick_distance(Vec2 local, float half_length, float half_width) {
    return std::max(std::abs(local.x) - half_length, std::abs(local.y) - half_width);
}

/// Half width of a pencil at `along`: constant, then a cone to the tip.
float taper(const PencilsScene::Pencil& pencil, float along) {
    if (pencil.plain) return pencil.half_width;
    return std::min(pencil.half_width, 0.22F * (pencil.half_length - along));
}

/// Sun through a window: bright panes, darker bars.
float sun_on(Vec2 point) {
    const float along = 0.83F * point.x + 0.56F * point.y;
    const float across = 0.56F * point.x - 0.83F * point.y;
    const auto panes = [](float x, float pitch, float bar) {
        const float in = std::abs(2 * fraction(x / pitch) - 1);
        return smooth_step(1 - bar + 0.05F, 1 - bar - 0.05F, in);
    };
    return panes(along + 0.25F, 0.62F, 0.2F) * panes(across + 0.25F, 0.78F, 0.16F);
}

}  // namespace

PencilsScene::PencilsScene(const SceneTextures& textures, float aspect)
    : textures_(&textures),
      extent_{aspect + 2 * kMargin, 1 + 2 * kMargin},
      tile_cols_(floor_int(aspect / kTile) + 1) {
    for (std::uint32_t i = 0; i < kPencils; ++i) pencils_[i] = random_pencil(i);
}

PencilsScene::Pencil PencilsScene::random_pencil(std::uint32_t item) const {
    const auto draw = [&](float low, float high, std::uint32_t field) {
        return textures_->random.between(low, high, item, 0x30000U + field);
    };
    Pencil pencil;
    pencil.plain = draw(0, 1, 0) < 0.35F;
    pencil.half_length = pencil.plain ? draw(0.08F, 0.20F, 1) : draw(0.10F, 0.22F, 1);
    pencil.half_width = pencil.plain ? draw(0.0035F, 0.007F, 2) : draw(0.009F, 0.0145F, 2);
    pencil.start = {draw(0, extent_.x, 3), draw(0, extent_.y, 4)};
    pencil.velocity = kPixel * draw(1, 4.5F, 5) * direction(static_cast<double>(draw(0, 1, 6)));
    pencil.start_turns = draw(0, 1, 7);
    // The turn adds at most 1.5 px per slot at the ends.
    pencil.turns_per_slot = draw(-1.5F, 1.5F, 8) * kPixel / (6.2832F * pencil.half_length);
    pencil.colour = kColours[static_cast<std::size_t>(draw(0, 8.999F, 9))];
    return pencil;
}

PencilsScene::Posed PencilsScene::pose(const Pencil& pencil, double time) const {
    const auto moved = [time](float start, float velocity, float extent) {
        const double x = static_cast<double>(start) + time * static_cast<double>(velocity);
        return static_cast<float>(wrapped(x, static_cast<double>(extent))) - 0.5F * extent;
    };
    Posed posed;
    posed.centre = {moved(pencil.start.x, pencil.velocity.x, extent_.x),
                    moved(pencil.start.y, pencil.velocity.y, extent_.y)};
    posed.axis = direction(static_cast<double>(pencil.start_turns) +
                           time * static_cast<double>(pencil.turns_per_slot));
    // It rolls as far as it moves sideways: corners of the hexagon lie every sixth of a turn.
    const Vec2 side{-posed.axis.y, posed.axis.x};
    const double rolled = static_cast<double>(dot(pencil.velocity, side)) * time /
                          (6.2832 * static_cast<double>(pencil.half_width));
    const double first = wrapped(rolled, 1.0 / 6) - 0.25;
    const Vec3 half = normalized(kToSun + Vec3{0, 0, 1});
    for (std::size_t k = 0; k < 4; ++k) {
        const double corner = first + static_cast<double>(k) / 6;
        if (k < 3) posed.edge[k] = wave(corner);
        const Vec2 up = direction(corner - 1.0 / 12);
        const Vec3 normal{up.y * side.x, up.y * side.y, up.x};
        posed.light[k] = std::max(0.0F, dot(normal, kToSun));
        posed.highlight[k] = power64(std::max(0.0F, dot(normal, half)));
    }
    return posed;
}

std::vector<PencilsScene::PencilSet> PencilsScene::near_tiles(
    const std::array<Posed, kPencils>& posed) const {
    const auto cols = static_cast<std::size_t>(tile_cols_);
    std::vector<PencilSet> near(cols * kTileRows);
    const float reach = 0.71F * kTile + 0.03F;  // half diagonal, shadow offset and blur
    for (std::size_t tile = 0; tile < near.size(); ++tile) {
        const std::size_t row = tile / cols;
        const Vec2 centre{
            (static_cast<float>(tile % cols) + 0.5F - 0.5F * static_cast<float>(cols)) * kTile,
            (static_cast<float>(row) + 0.5F) * kTile - 0.5F};
        for (std::size_t i = 0; i < kPencils; ++i) {
            const Vec2 away = centre - posed[i].centre;
            const Vec2 local{dot(posed[i].axis, away),
                             posed[i].axis.x * away.y - posed[i].axis.y * away.x};
            if (stick_distance(local, pencils_[i].half_length, pencils_[i].half_width) < reach)
                near[tile][i / 64] |= std::uint64_t{1} << (i % 64);
        }
    }
    return near;
}

const PencilsScene::PencilSet& PencilsScene::near_point(const Instant& instant,
                                                        Vec2 point) const noexcept {
    const int col = floor_int(point.x / kTile + 0.5F * static_cast<float>(tile_cols_));
    const int row = floor_int((point.y + 0.5F) / kTile);
    const int tile =
        std::clamp(row, 0, kTileRows - 1) * tile_cols_ + std::clamp(col, 0, tile_cols_ - 1);
    return instant.near[static_cast<std::size_t>(tile)];
}

PencilsScene::Instant PencilsScene::at(double time) const {
    Instant instant;
    instant.scene = this;
    for (std::size_t i = 0; i < kPencils; ++i) instant.posed[i] = pose(pencils_[i], time);
    instant.near = near_tiles(instant.posed);
    return instant;
}

Rgb PencilsScene::Instant::radiance(Vec2 point, Vec2 /*stratum*/) const noexcept {
    const Vec2 from_cup = point - kCup;
    if (dot(from_cup, from_cup) < square(kCupRadius)) return scene->cup(from_cup);
    const Vec2 cup_shadow = from_cup - 4 * kShadowOffset;
    float shadow =
        smooth_step(kCupRadius - 0.02F, kCupRadius + 0.03F, std::sqrt(dot(cup_shadow, cup_shadow)));
    const PencilSet& near_set = scene->near_point(*this, point);
    // From the top down: the first pencil hit is seen, those above it only cast shadows.
    for (std::size_t word = 0; word < near_set.size(); ++word) {
        for (std::uint64_t bits = near_set[word]; bits != 0; bits &= bits - 1) {
            const std::size_t i = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
            const Posed& pose = posed[i];
            const Pencil& pencil = scene->pencils_[i];
            const auto local = [&](Vec2 away) {
                return Vec2{dot(pose.axis, away), pose.axis.x * away.y - pose.axis.y * away.x};
            };
            const Vec2 on = local(point - pose.centre);
            if (stick_distance(on, pencil.half_length, taper(pencil, on.x)) < 0) {
                const float sun = sun_on(point) * shadow;
                return (0.28F + 1.05F * sun) * scene->pencil_light(pencil, pose, on);
            }
            const Vec2 behind = local(point - pose.centre - kShadowOffset);
            shadow *=
                smooth_step(-kShadowBlur, kShadowBlur,
                            stick_distance(behind, pencil.half_length, taper(pencil, behind.x)));
        }
    }
    const float sun = sun_on(point) * shadow;
    const Rgb light =
        mix(0.6F, 1, shadow) * Rgb{0.17F, 0.19F, 0.23F} + sun * Rgb{0.92F, 0.84F, 0.70F};
    return light * scene->desk(point);
}

}  // namespace stipple
