#include <algorithm>

#include "study/scenes/embedded_scenes.h"
#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr float kCell = 0.5F;  // one house each
constexpr float kFloor = 0.125F;
constexpr float kWindowHalfWidth = 0.027F;
constexpr float kWindowHalfHeight = 0.036F;
constexpr Rgb kDusk{0.62F, 0.60F, 0.70F};  // light of the sky on a wall
constexpr Rgb kLampLight{1.9F, 1.15F, 0.55F};

constexpr std::array<Rgb, 6> kPlaster{{{0.72F, 0.52F, 0.30F},
                                       {0.68F, 0.66F, 0.58F},
                                       {0.40F, 0.50F, 0.55F},
                                       {0.70F, 0.38F, 0.28F},
                                       {0.45F, 0.52F, 0.36F},
                                       {0.62F, 0.45F, 0.42F}}};

Rgb door_lamp(Vec2 from_door) {
    const Vec2 away = from_door - Vec2{0.062F, 0.125F};
    return 1 / square(1 + dot(away, away) / square(0.075F)) * kLampLight;
}

}  // namespace

PanScene::PanScene(const SceneTextures& textures) : textures_(&textures) {
    const SceneRandom& random = textures.random;
    for (std::uint32_t i = 0; i < houses_.size(); ++i) {
        House& house = houses_[i];
        const auto draw = [&](float low, float high, std::uint32_t field) {
            return random.between(low, high, i, 0x10000U + field);
        };
        house.brick = draw(0, 1, 0) < 0.4F;
        house.wall =
            kPlaster[(i * 5 + static_cast<std::uint32_t>(draw(0, 3, 1))) % kPlaster.size()];
        if (house.brick) house.wall = {0.46F, 0.20F + draw(0, 0.06F, 2), 0.14F};
        house.roof = mix({0.34F, 0.14F, 0.09F}, {0.16F, 0.17F, 0.20F}, draw(0, 1, 3));
        house.half_width = draw(0.205F, 0.243F, 4);
        house.eaves = kFloor * (2 + std::floor(draw(0, 2, 5))) + 0.03F;
        house.ridge = draw(0.07F, 0.13F, 6);
        house.window_columns = draw(0, 1, 7) < 0.5F ? 3 : 4;
        house.lit = static_cast<std::uint32_t>(draw(0, 65536, 8)) &
                    static_cast<std::uint32_t>(draw(0, 65536, 9));
        house.stain = {draw(0, 1, 10), draw(0, 1, 11)};
    }
}

std::optional<Rgb> PanScene::house(Vec2 world) const noexcept {
    if (world.y < 0 || world.y > 0.6F) return {};
    const int cell = floor_int(world.x / kCell);
    const House& house = houses_[static_cast<std::size_t>(cell & 15)];
    const Vec2 local{world.x - (static_cast<float>(cell) + 0.5F) * kCell, world.y};
    const float across = std::abs(local.x) - house.half_width;
    if (across < 0 && local.y < house.eaves) return facade(house, local);
    const float slope = house.ridge / (0.8F * house.half_width);
    const bool below_ridge =
        local.y < house.eaves + std::min(house.ridge, -slope * (across - 0.012F));
    if (local.y >= house.eaves && across < 0.012F && below_ridge) return roof(house, local);
    const float chimney = local.x - 0.45F * house.half_width;
    if (std::abs(chimney) < 0.016F && local.y > house.eaves &&
        local.y < house.eaves + house.ridge + 0.03F)
        return brick(local + house.stain, 0.016F, 0.009F) * 0.3F * Rgb{0.62F, 0.34F, 0.28F};
    return {};
}

Rgb PanScene::roof(const House& house, Vec2 local) const noexcept {
    const float row = (local.y - house.eaves) / 0.013F;
    const float tile = local.x / 0.014F + 0.5F * static_cast<float>(floor_int(row) & 1);
    const float shade = mix(0.55F, 1.15F, fraction(row)) * (fraction(tile) < 0.12F ? 0.65F : 1.0F) *
                        (1 + 0.22F * textures_->coarse.at(local.x + house.stain.x, local.y));
    const float gutter = local.y - house.eaves < 0.008F ? 0.35F : 1.0F;
    return gutter * shade * (house.roof * Rgb{1.0F, 0.92F, 0.98F});
}

std::optional<Rgb> PanScene::window(const House& house, Vec2 local) const noexcept {
    const auto columns = static_cast<float>(house.window_columns);
    const float pitch = 2 * house.half_width / columns;
    const int column = floor_int((local.x + house.half_width) / pitch);
    const int level = floor_int(local.y / kFloor);
    const Vec2 p{local.x + house.half_width - (static_cast<float>(column) + 0.5F) * pitch,
                 local.y - (static_cast<float>(level) + 0.56F) * kFloor};
    const float dx = std::abs(p.x);
    const float dy = std::abs(p.y);
    if (level == 0 && column == house.window_columns / 2) return {};  // the door
    if (static_cast<float>(level + 1) * kFloor > house.eaves) return {};
    if (dx > kWindowHalfWidth + 0.006F || dy > kWindowHalfHeight + 0.008F) return {};
    if (dx > kWindowHalfWidth || dy > kWindowHalfHeight)
        return p.y < -kWindowHalfHeight ? Rgb{0.50F, 0.48F, 0.46F} : Rgb{0.42F, 0.41F, 0.42F};
    if (dx < 0.002F || std::abs(p.y - 0.010F) < 0.002F || dx > 0.0245F || dy > 0.0335F)
        return Rgb{0.50F, 0.49F, 0.50F};
    const int index = (level * house.window_columns + column) & 15;
    if ((house.lit >> static_cast<unsigned>(index) & 1U) != 0) {
        const float curtain = 0.75F + 0.25F * smooth_step(0.004F, 0.02F, dx) *
                                          (fraction(p.x / 0.006F) < 0.5F ? 0.4F : -0.9F);
        return curtain * Rgb{1.75F, 1.20F, 0.55F};
    }
    const float reflection = clamp01(0.5F + (p.y + 0.4F * p.x) / 0.09F);
    return mix(Rgb{0.012F, 0.015F, 0.022F}, {0.20F, 0.17F, 0.20F}, reflection * reflection);
}

Rgb PanScene::facade(const House& house, Vec2 local) const noexcept {
    if (const auto pane = window(house, local)) return *pane;
    const float pitch = 2 * house.half_width / static_cast<float>(house.window_columns);
    const int middle = house.window_columns / 2;
    const Vec2 door{local.x + house.half_width - (static_cast<float>(middle) + 0.5F) * pitch,
                    local.y};
    const Vec2 bulb = door - Vec2{0.062F, 0.122F};
    if (dot(bulb, bulb) < square(0.0065F)) return {7.0F, 4.6F, 2.4F};
    const Vec2 round{door.x, std::max(0.0F, door.y - 0.085F)};
    const float arch = std::sqrt(dot(round, round));
    const float grain = textures_->coarse.at(local.x + house.stain.x, local.y + house.stain.y);
    if (arch < 0.034F)  // an open archway: the deepest shadow of the image
        return (3e-4F * (1 + 0.3F * grain)) * Rgb{1, 0.85F, 0.75F} +
               0.004F * square(clamp01(1 - door.y / 0.03F)) * Rgb{1, 0.8F, 0.6F};
    const float stain = textures_->smooth.at(local.x + house.stain.x, local.y + house.stain.y);
    float shade = (1 + 0.10F * stain + 0.10F * grain) *
                  mix(0.78F, 1.0F, smooth_step(0, 0.12F, local.y)) *
                  mix(0.55F, 1.0F, smooth_step(0, 0.03F, house.eaves - local.y));
    if (house.brick) shade *= brick(local + house.stain, 0.026F, 0.0125F);
    Rgb albedo = house.wall;
    if (arch < 0.043F) albedo = {0.55F, 0.52F, 0.48F};
    if (local.y < 0.022F) albedo = 0.45F * albedo;
    return shade * (albedo * (kDusk + door_lamp(door)));
}

}  // namespace stipple
