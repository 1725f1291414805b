#pragma once

#include <array>
#include <optional>

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

/// Dice that bounce and tumble over an inlaid board beside a steel ball, ray-cast in space. World:
/// the top of the board is z = 0, x to the right, y away from the camera; a length of 1 fills about
/// the image height at the centre of the board.
class DiceScene {
  public:
    static constexpr Vec3 kBall{0.50F, -0.29F,
                                0.085F};  ///< centre of the ball, which lies on the board

    explicit DiceScene(const SceneTextures& textures);

    static constexpr std::size_t kDice = 6;

    /// A die and its motion: a closed path, bounces, and turns about three axes at once.
    struct Die {
        float half = 0;  ///< half edge
        Vec2 home;
        Vec2 sweep;       ///< half width of the path
        float hop = 0;    ///< height of the bounces
        float start = 0;  ///< 0..1, phase of its cycles at time 0
        Rgb colour;
        Rgb pips;
    };
    struct Posed {
        Vec3 centre;
        Rotation turn;  ///< world to die
    };
    struct Ray {
        Vec3 origin;
        Vec3 direction;  ///< unit length
    };
    struct Hit {
        float distance = 0;
        std::size_t die = 0;
        Vec3 local;    ///< point on the die, in half edges
        int axis = 0;  ///< of the face
    };

    /// The scene at one instant.
    struct Instant {
        /// `stratum` selects the point of the lamp for the shadow.
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        [[nodiscard]] std::optional<Hit> nearest_die(const Ray& ray) const noexcept;
        [[nodiscard]] bool shadowed(Vec3 point, Vec3 to_lamp) const noexcept;
        [[nodiscard]] Rgb die_light(const Ray& ray, const Hit& hit, Vec3 lamp) const noexcept;
        [[nodiscard]] Rgb board_light(const Ray& ray, Vec3 lamp) const noexcept;
        [[nodiscard]] Rgb ball_light(const Ray& ray, float distance, Vec3 lamp) const noexcept;

        const DiceScene* scene = nullptr;
        std::array<Posed, kDice> posed;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    Posed pose(const Die& die, double time) const;
    Rgb table_light(Vec2 point) const noexcept;
    Rgb board_albedo(Vec2 point) const noexcept;
    Rgb die_albedo(const Die& die, const Hit& hit) const noexcept;

    const SceneTextures* textures_;
    Rotation camera_;  ///< rows: right, down, forward
    std::array<Die, kDice> dice_;
};

}  // namespace stipple
