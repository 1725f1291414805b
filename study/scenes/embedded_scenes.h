#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "study/scenes/surfaces.h"
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

struct House {
    Rgb wall;
    Rgb roof;
    float half_width = 0;
    float eaves = 0;  ///< height of the wall
    float ridge = 0;  ///< height of the roof above it
    int window_columns = 3;
    std::uint32_t lit = 0;  ///< one bit per window
    bool brick = false;
    Vec2 stain;  ///< position of its wall in the textures
};

/// A street at dusk seen from a moving carriage. World: X along the street (with period 8), heights
/// above the ground. An object at scale s appears at x = (X - camera) s, so near objects (large s)
/// move faster. Image height = 1 unit, y down, origin in the centre.
class PanScene {
  public:
    static constexpr float kHouseScale = 1;  ///< 2.5 px per slot
    static constexpr float kTreeScale = 1.25F;
    static constexpr float kLampScale = 1.6F;     ///< 4 px per slot
    static constexpr float kRailingScale = 2.4F;  ///< 6 px per slot

    explicit PanScene(const SceneTextures& textures);

    /// The scene at one instant.
    struct Instant {
        /// Light from a point of the image. `stratum` (0..1 in each direction) is not used here.
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const PanScene* scene = nullptr;
        float camera = 0;  ///< X in the middle of the image
        float eye = 0;     ///< height of the eye above the ground
        Vec2 tilt;         ///< (cos, sin) of the camera's rotation

        [[nodiscard]] Vec2 world(Vec2 point, float scale) const noexcept;
        [[nodiscard]] Rgb sky(Vec2 point) const noexcept;
        [[nodiscard]] Rgb street(Vec2 point) const noexcept;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    std::optional<Rgb> railing(Vec2 world) const noexcept;
    std::optional<Rgb> lamp(Vec2 world) const noexcept;
    std::optional<Rgb> tree(Vec2 world) const noexcept;
    std::optional<Rgb> house(Vec2 world) const noexcept;
    std::optional<Rgb> hills(Vec2 world) const noexcept;
    Rgb ground(Vec2 world, float scale) const noexcept;

    Rgb roof(const House& house, Vec2 local) const noexcept;
    Rgb facade(const House& house, Vec2 local) const noexcept;
    std::optional<Rgb> window(const House& house, Vec2 local) const noexcept;

    const SceneTextures* textures_;
    std::array<House, 16> houses_;
};

/// Coloured pencils with individual sliding and turning motions over a desk with squared paper and
/// a deep steel cup, seen from above in low sunlight. Image height = 1 unit, y down, origin in the
/// centre.
class PencilsScene {
  public:
    /// `aspect` is width / height of the image.
    PencilsScene(const SceneTextures& textures, float aspect);

    static constexpr float kCupRadius = 0.135F;
    static constexpr std::size_t kPencils = 128;
    using PencilSet = std::array<std::uint64_t, kPencils / 64>;  ///< one bit each

    /// A pencil and its motion in slots; a `Posed` is the pencil at one instant.
    struct Pencil {
        Vec2 start;
        Vec2 velocity;
        float start_turns = 0;
        float turns_per_slot = 0;
        float half_length = 0;
        float half_width = 0;
        Rgb colour;
        bool plain = false;  ///< a round stick without tip and ferrule
    };
    struct Posed {
        Vec2 centre;
        Vec2 axis;                     ///< (cos, sin); the tip points along it
        std::array<float, 3> edge{};   ///< of the hexagon, -1..1 across the pencil
        std::array<float, 4> light{};  ///< on the facets between the edges
        std::array<float, 4> highlight{};
    };

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const PencilsScene* scene = nullptr;
        std::array<Posed, kPencils> posed;
        std::vector<PencilSet> near;  ///< per tile: pencils that may cover or shadow it
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    Pencil random_pencil(std::uint32_t item) const;
    Posed pose(const Pencil& pencil, double time) const;
    std::vector<PencilSet> near_tiles(const std::array<Posed, kPencils>& posed) const;
    const PencilSet& near_point(const Instant& instant, Vec2 point) const noexcept;

    Rgb pencil_light(const Pencil& pencil, const Posed& posed, Vec2 local) const noexcept;
    Rgb desk(Vec2 point) const noexcept;
    Rgb cup(Vec2 from_centre) const noexcept;

    const SceneTextures* textures_;
    Vec2 extent_;  ///< the area in which pencils wrap around, larger than the image
    int tile_cols_;
    std::array<Pencil, kPencils> pencils_;
};

/// Two inlaid discs that roll to and fro on the floor boards of a sunlit room, in opposite
/// directions. Image height = 1 unit, y down, origin in the centre.
class RollScene {
  public:
    static constexpr float kFloorLine = 0.14F;  ///< edge between wall and floor

    /// `aspect` is width / height of the image.
    RollScene(const SceneTextures& textures, float aspect);

    struct Disc {
        Vec2 centre;
        float radius = 0;
        Vec2 turn;  ///< (cos, sin) of its rotation
        Rgb ivory;  ///< its light inlay
        Rgb dark;   ///< its dark inlay
        [[nodiscard]] float foot() const { return centre.y + radius; }
    };

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const RollScene* scene = nullptr;
        std::array<Disc, 2> discs;  ///< front first
        [[nodiscard]] float wall_shadow(Vec2 point) const noexcept;
        [[nodiscard]] float floor_shadow(Vec2 point) const noexcept;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    Rgb face(const Disc& disc, Vec2 from_centre) const noexcept;
    Rgb inlay(const Disc& disc, Vec2 local, float rho) const noexcept;
    Rgb tread(const Disc& disc, Vec2 from_centre) const noexcept;
    Rgb wall(Vec2 point, float shadow) const noexcept;
    Rgb ground(Vec2 point, float shadow) const noexcept;

    const SceneTextures* textures_;
    double amplitude_;  // of the path of the front disc
    float phase_;
};

/// A quiet room seen by a hand-held camera: a bright window with the sun, a hanging lamp, shelves
/// with deep shadows, a table. All motion is below about a pixel per slot. Image height = 1 unit, y
/// down, origin in the centre.
class StillScene {
  public:
    static constexpr float kTableEdge = 0.245F;  ///< height of the far edge of the table

    explicit StillScene(const SceneTextures& textures);

    /// The scene at one instant.
    struct Instant {
        [[nodiscard]] Rgb radiance(Vec2 point, Vec2 stratum) const noexcept;

        const StillScene* scene = nullptr;
        Vec2 sway;         ///< of the camera, for objects at the distance of the wall
        Vec2 lamp;         ///< position of the lamp, on the scale of the wall
        Vec2 lamp_axis;    ///< (cos, sin) of its swing
        float breeze = 0;  ///< -1..1, moves curtain and leaves
        float leaf_turn = 0;

        [[nodiscard]] std::optional<Rgb> plant(Vec2 point) const noexcept;
        [[nodiscard]] std::optional<Rgb> hanging_lamp(Vec2 point) const noexcept;
        [[nodiscard]] std::optional<Rgb> curtain(Vec2 point) const noexcept;
        [[nodiscard]] Rgb outside(Vec2 point) const noexcept;
        [[nodiscard]] Rgb table(Vec2 point) const noexcept;
        [[nodiscard]] Rgb room_light(Vec2 point) const noexcept;
        [[nodiscard]] Rgb wall(Vec2 point) const noexcept;
    };

    [[nodiscard]] Instant at(double time) const;

  private:
    std::optional<Rgb> shelf(Vec2 point) const noexcept;
    Rgb books(int row, Vec2 in_row) const noexcept;

    const SceneTextures* textures_;
};

}  // namespace stipple
