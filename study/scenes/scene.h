#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include "core/geometry.h"
#include "core/progress.h"

namespace stipple {

/// The embedded scenes; docs/scenes.md describes them.
enum class SceneName {
    kPan,
    kRoll,
    kPencils,
    kDice,
    kStill,
};

struct NamedScene {
    std::string_view name;
    SceneName scene;
    std::string_view text;  ///< one line of description
};

[[nodiscard]] std::span<const NamedScene> scenes();

/// \throws InputError listing the names of `scenes`.
[[nodiscard]] SceneName scene_from_name(std::string_view name);

struct SceneOptions {
    static constexpr int kMaxSlots = 1'000'000;
    static constexpr int kMinSide = 8;
    static constexpr int kMaxSide = 4096;

    int slots = 48;                                           ///< 1..kMaxSlots
    FrameShape shape{.rows = 240, .cols = 320, .planes = 3};  ///< kMinSide..kMaxSide; 1 or 3 planes
    std::uint64_t seed = 1;    ///< of textures, colours and arrangement; the motion is similar
    double slot_duration = 1;  ///< in 1/200 s, the unit of the speeds; 0.01..8
    int time_samples = 8;      ///< per 1/200 s and 240 rows, 1..64; 8 keeps steps below a pixel
};

/// A synthetic HDR scene in linear light, 1.0 = `photons_per_unit` of the sensor. A frame is the
/// integral over its whole slot and the whole area of each pixel, by stratified sampling. At least
/// 14 stops between the darkest 0.1 % and the brightest site; mean 0.2..0.4. A scene of fewer slots
/// equals the first slots of a longer one. One plane is Rec. 709 luminance.
class Scene {
  public:
    /// \throws InputError naming the option that is out of range.
    explicit Scene(SceneName name, const SceneOptions& options = {});
    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;

    [[nodiscard]] const SceneOptions& options() const;

    /// Writes the light of one slot, order (plane, row, col), into `frame` (shape.sites() floats).
    /// The same bits for any thread count, in any order of slots, with any compiler. `progress`
    /// receives the part of the frame that is done, 0..1, and returns false to stop; then the frame
    /// is incomplete. Returns whether it is complete. Precondition: 0 <= slot < options().slots.
    bool render(
        int slot, std::span<float> frame,
        const ProgressCallback& progress = [](double) { return true; }) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stipple
