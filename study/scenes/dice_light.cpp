#include <algorithm>

#include "study/scenes/embedded_scenes.h"
#include "study/scenes/surfaces.h"

namespace stipple {

namespace {

constexpr Rgb kLampLight{1.95F, 1.74F, 1.44F};
constexpr Rgb kSky{0.33F, 0.36F, 0.42F};
constexpr Vec2 kBoard{0.80F, 0.569F};  // half size
constexpr float kRail = 0.055F;

/// Which pips a face shows: bit 3 row + col of a 3 x 3 grid.
constexpr std::array<unsigned, 7> kPips{0,           0b000010000, 0b100000001, 0b100010001,
                                        0b101000101, 0b101010101, 0b101101101};

/// Position on a face, -1..1 each way, of a point on the die.
Vec2 on_face(const DiceScene::Hit& hit) {
    if (hit.axis == 0) return {hit.local.y, hit.local.z};
    if (hit.axis == 1) return {hit.local.z, hit.local.x};
    return {hit.local.x, hit.local.y};
}

/// 1..6; opposite faces add up to seven.
int face_value(const DiceScene::Hit& hit) {
    const float side = hit.axis == 0 ? hit.local.x : hit.axis == 1 ? hit.local.y : hit.local.z;
    const int value = hit.axis + 1;
    return side > 0 ? value : 7 - value;
}

/// Distance to the nearest pip's centre, in half edges; large where there is none.
float pip_distance(Vec2 face, int value) {
    const float col = std::clamp(static_cast<float>(floor_int(face.x / 0.52F + 0.5F)), -1.0F, 1.0F);
    const float row = std::clamp(static_cast<float>(floor_int(face.y / 0.52F + 0.5F)), -1.0F, 1.0F);
    const auto bit = static_cast<unsigned>((row + 1) * 3 + col + 1);
    if ((kPips[static_cast<std::size_t>(value)] >> bit & 1U) == 0) return 1;
    const Vec2 away = face - 0.52F * Vec2{col, row};
    return std::sqrt(dot(away, away));
}

/// The outward normal in the die's frame, rounded near the edges.
Vec3 rounded_normal(Vec3 local) {
    const auto bend = [](float x) {
        const float over = std::max(0.0F, std::abs(x) - 0.86F) / 0.14F;
        return x > 0 ? over * over : -over * over;
    };
    return normalized({bend(local.x), bend(local.y), bend(local.z)});
}

}  // namespace

Rgb DiceScene::die_albedo(const Die& die, const Hit& hit) const noexcept {
    const Vec2 face = on_face(hit);
    const float pip = pip_distance(face, face_value(hit));
    if (pip < 0.185F) return die.pips;
    const float edge = std::max(std::abs(face.x), std::abs(face.y));
    const Vec2 p = die.half * face + Vec2{die.start, 0.3F * static_cast<float>(hit.axis)};
    const float veins = textures_->smooth.at(1.5F * p.x, 1.5F * p.y);
    const float grain = textures_->coarse.at(2 * p.x, 2 * p.y);
    const float line = std::abs(edge - 0.80F) < 0.018F ? 0.55F : 1.0F;  // an engraved frame
    return line * (pip < 0.22F ? 0.6F : 1.0F) * (1 + 0.10F * veins + 0.13F * grain) * die.colour;
}

Rgb DiceScene::Instant::die_light(const Ray& ray, const Hit& hit, Vec3 lamp) const noexcept {
    const Posed& pose = posed[hit.die];
    const Vec3 normal = pose.turn.apply_inverse(rounded_normal(hit.local));
    const Vec3 point = ray.origin + hit.distance * ray.direction;
    const Vec3 to_lamp = normalized(lamp - point);
    const float facing = dot(normal, to_lamp);
    const float lit = facing > 0 && !shadowed(point + 1e-3F * normal, lamp - point) ? facing : 0.0F;
    const Rgb albedo = scene->die_albedo(scene->dice_[hit.die], hit);
    // Skylight from above, and the board's warm light from below.
    const float up = 0.5F + 0.5F * normal.z;
    const Rgb ambient = mix(Rgb{0.20F, 0.15F, 0.10F}, kSky, up);
    const Vec3 mirrored = ray.direction - 2 * dot(ray.direction, normal) * normal;
    const float mirror = std::max(0.0F, dot(mirrored, to_lamp));
    // A flat face would mirror the lamp all at once; only its rounded edges glint hard.
    const Vec2 face = on_face(hit);
    const bool edge = std::max(std::abs(face.x), std::abs(face.y)) > 0.86F;
    const float glint = (edge ? 4.0F : 0.35F) * power16(power16(mirror));
    const float gloss = lit > 0 ? 0.25F * power16(mirror) + glint : 0.0F;
    const float fresnel = 0.04F + 0.5F * square(square(clamp01(1 + dot(ray.direction, normal))));
    return albedo * (ambient + lit * kLampLight) + gloss * kLampLight +
           fresnel * clamp01(mirrored.z + 0.2F) * kSky;
}

Rgb DiceScene::board_albedo(Vec2 point) const noexcept {
    const Vec2 inside = kBoard - Vec2{std::abs(point.x), std::abs(point.y)};
    const float rim = std::min(inside.x, inside.y);
    const float grain = textures_->coarse.at(point.x, point.y);
    if (rim < kRail)  // the rail, mitred: its grain runs along it
        return 0.55F * wood(*textures_, inside.x < inside.y ? point : Vec2{point.y, point.x});
    if (rim < kRail + 0.008F) return {0.55F, 0.40F, 0.15F};
    if (rim < kRail + 0.05F) return (1 + 0.13F * grain) * Rgb{0.03F, 0.11F, 0.06F};
    const Vec2 square_at{point.x / 0.116F + 20, point.y / 0.116F + 20};
    const int parity = (floor_int(square_at.x) + floor_int(square_at.y)) & 1;
    const Vec2 in{std::abs(fraction(square_at.x) - 0.5F), std::abs(fraction(square_at.y) - 0.5F)};
    if (std::max(in.x, in.y) > 0.485F) return {0.06F, 0.04F, 0.02F};
    const bool diamond = in.x + in.y < 0.20F;
    if (diamond != (parity != 0)) return 0.42F * wood(*textures_, point);
    return (1 + 0.10F * grain) * (Rgb{0.85F, 0.85F, 0.8F} * wood(*textures_, {point.y, point.x}) +
                                  Rgb{0.20F, 0.18F, 0.13F});
}

Rgb DiceScene::table_light(Vec2 point) const noexcept {
    const Vec2 beyond{std::max(0.0F, std::abs(point.x) - kBoard.x),
                      std::max(0.0F, std::abs(point.y) - kBoard.y)};
    const float away = std::sqrt(dot(beyond, beyond));
    const float contact = smooth_step(-0.02F, 0.05F, away);  // the board's own shadow
    const float lit = 0.30F * contact * square(smooth_step(0.46F, 0.0F, away));
    return (lit + 9e-4F) * planks(*textures_, {point.y + 3, point.x}, 0.21F);
}

Rgb DiceScene::Instant::board_light(const Ray& ray, Vec3 lamp) const noexcept {
    if (ray.direction.z > -0.02F) return 3e-4F * kSky;  // the dark of the room
    const float distance = ray.origin.z / -ray.direction.z;
    const Vec3 point = ray.origin + distance * ray.direction;
    if (std::abs(point.x) > kBoard.x || std::abs(point.y) > kBoard.y)
        return scene->table_light({point.x, point.y});
    const Vec3 to_lamp = lamp - point;
    const float lit = shadowed(point, to_lamp) ? 0.0F : normalized(to_lamp).z;
    float sky = 1;  // skylight that the things above take away
    for (std::size_t i = 0; i < kDice; ++i) {
        const float half = scene->dice_[i].half;
        const Vec2 away{point.x - posed[i].centre.x, point.y - posed[i].centre.y};
        sky *= 1 - 0.75F * square(half) * 1.3F /
                       (dot(away, away) + square(posed[i].centre.z - 0.6F * half) +
                        0.3F * square(half));
    }
    const Vec2 from_ball{point.x - kBall.x, point.y - kBall.y};
    sky *= 1 - 0.8F * light_pool(dot(from_ball, from_ball), 0.07F);
    const Rgb albedo = scene->board_albedo({point.x, point.y});
    return albedo * (std::max(0.1F, sky) * kSky + lit * kLampLight);
}

Rgb DiceScene::Instant::ball_light(const Ray& ray, float distance, Vec3 lamp) const noexcept {
    const Vec3 point = ray.origin + distance * ray.direction;
    const Vec3 normal = normalized(point - kBall);
    const Ray mirrored{point + 1e-3F * normal,
                       ray.direction - 2 * dot(ray.direction, normal) * normal};
    const Vec3 to_lamp = normalized(lamp - point);
    const float mirror = dot(mirrored.direction, to_lamp);
    if (mirror > 0.975F) return {14, 12.5F, 10};
    Rgb seen = mix(Rgb{0.05F, 0.045F, 0.05F}, {0.40F, 0.44F, 0.52F},
                   square(clamp01(mirrored.direction.z)));
    if (const auto hit = nearest_die(mirrored))
        seen = die_light(mirrored, *hit, lamp);
    else if (mirrored.direction.z < 0)
        seen = board_light(mirrored, lamp);
    return Rgb{0.75F, 0.76F, 0.80F} * seen;
}

}  // namespace stipple
