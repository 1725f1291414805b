#pragma once

#include <array>
#include <optional>

#include "study/scenes/noise_texture.h"
#include "study/scenes/vector.h"

namespace stipple {

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

}  // namespace stipple
