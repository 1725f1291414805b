#include "study/scenes/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "core/parallel.h"
#include "study/scenes/embedded_scenes.h"

namespace stipple {

namespace {

constexpr int kSamplesPerPixel = 32;  // in one slot, over time and area together
constexpr int kDefaultRows = 240;

constexpr std::array<NamedScene, 5> kScenes{
    {{"pan", SceneName::kPan, "a street at dusk passing by: large camera motion over depth"},
     {"roll", SceneName::kRoll, "discs with fine texture rolling on a textured ground"},
     {"pencils", SceneName::kPencils, "many thin coloured things, each moving its own way"},
     {"dice", SceneName::kDice, "fast, complex rotation: cubes tumbling over a board"},
     {"still", SceneName::kStill, "small motion; a bright window and deep shadow"}}};

using SceneModel = std::variant<PanScene, RollScene, PencilsScene, DiceScene, StillScene>;

SceneModel make_model(SceneName name, const SceneTextures& textures, float aspect) {
    switch (name) {
        case SceneName::kRoll:
            return RollScene(textures, aspect);
        case SceneName::kPencils:
            return PencilsScene(textures, aspect);
        case SceneName::kDice:
            return DiceScene(textures);
        case SceneName::kStill:
            return StillScene(textures);
        case SceneName::kPan:
            break;
    }
    return PanScene(textures);
}

void require(bool holds, std::string_view option, std::string_view range) {
    if (!holds) throw InputError(std::string("scene option ").append(option), range);
}

void check(const SceneOptions& options) {
    const FrameShape shape = options.shape;
    const auto within = [](int value, int min, int max, std::string_view option) {
        require(value >= min && value <= max, option, fmt::format("must be {}..{}", min, max));
    };
    within(options.slots, 1, SceneOptions::kMaxSlots, "slots");
    within(shape.rows, SceneOptions::kMinSide, SceneOptions::kMaxSide, "rows");
    within(shape.cols, SceneOptions::kMinSide, SceneOptions::kMaxSide, "cols");
    require(shape.planes == 1 || shape.planes == 3, "planes", "must be 1 (mono) or 3 (RGB)");
    require(options.slot_duration >= 0.01 && options.slot_duration <= 8, "slot_duration",
            "must be 0.01..8 slots of 1/200 s");
    require(options.time_samples >= 1 && options.time_samples <= 64, "time_samples",
            "must be 1..64");
}

/// Where the samples of a pixel lie, in time and area.
struct SamplePlan {
    explicit SamplePlan(const SceneOptions& options) {
        // Speeds grow with the image: so do the samples in time, to keep steps below a pixel.
        const double growth = std::max(1.0, options.shape.rows / static_cast<double>(kDefaultRows));
        const int per_unit = static_cast<int>(std::ceil(options.time_samples * growth));
        instants = static_cast<int>(std::ceil(per_unit * options.slot_duration));
        per_instant = std::max(2, kSamplesPerPixel / per_unit);
        // A rank-1 sequence: any run of it is spread evenly. The constants are the inverse powers
        // of the plastic number (Roberts 2018). It starts again every 1/200 s, so a slot of twice
        // the duration has the samples of its two halves.
        for (int i = 0; i < instants * per_instant; ++i) {
            const int k = i % (per_unit * per_instant);
            strata.push_back({static_cast<float>(wrapped(0.5 + k * 0.7548776662466927, 1)),
                              static_cast<float>(wrapped(0.5 + k * 0.5698402909980532, 1))});
        }
    }

    int instants = 0;
    int per_instant = 0;
    std::vector<Vec2> strata;  ///< 0..1 of a pixel each way, per instant and sample
};

/// Mean radiance of one pixel's samples; `corner` is its upper left corner in pixels.
template <typename Instant>
Rgb integrate_pixel(const std::vector<Instant>& instants, const SamplePlan& plan, Vec2 corner,
                    float pixel_size) {
    Rgb sum;
    auto stratum = plan.strata.begin();
    for (const Instant& instant : instants)
        for (int k = 0; k < plan.per_instant; ++k, ++stratum)
            sum = sum + instant.radiance(pixel_size * (corner + *stratum), *stratum);
    return 1 / static_cast<float>(plan.strata.size()) * sum;
}

void store(Rgb light, const FrameShape& shape, std::size_t pixel, std::span<float> frame) {
    if (shape.planes == 1) {
        frame[pixel] = 0.2126F * light.x + 0.7152F * light.y + 0.0722F * light.z;
        return;
    }
    frame[pixel] = light.x;
    frame[pixel + shape.pixels()] = light.y;
    frame[pixel + 2 * shape.pixels()] = light.z;
}

}  // namespace

std::span<const NamedScene> scenes() {
    return kScenes;
}

SceneName scene_from_name(std::string_view name) {
    for (const NamedScene& known : kScenes)
        if (known.name == name) return known.scene;
    throw InputError(std::string("scene ").append(name),
                     "is not one of pan, roll, pencils, dice, still");
}

struct Scene::Impl {
    Impl(SceneName name, const SceneOptions& scene_options)
        : options(scene_options),
          plan(options),
          textures(options.shape.rows, options.seed),
          model(make_model(
              name, textures,
              static_cast<float>(options.shape.cols) / static_cast<float>(options.shape.rows))) {}

    SceneOptions options;
    SamplePlan plan;
    SceneTextures textures;
    SceneModel model;  // refers to textures
};

Scene::Scene(SceneName name, const SceneOptions& options) {
    check(options);
    impl_ = std::make_unique<Impl>(name, options);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

const SceneOptions& Scene::options() const {
    return impl_->options;
}

bool Scene::render(int slot, std::span<float> frame, const ProgressCallback& progress) const {
    const SceneOptions& options = impl_->options;
    const SamplePlan& plan = impl_->plan;
    const FrameShape shape = options.shape;
    assert(slot >= 0 && slot < options.slots && frame.size() == shape.sites());
    const float pixel_size = 1 / static_cast<float>(shape.rows);
    return std::visit(
        [&](const auto& model) {
            std::vector<decltype(model.at(0.0))> instants;
            instants.reserve(static_cast<std::size_t>(plan.instants));
            for (int i = 0; i < plan.instants; ++i)
                instants.push_back(
                    model.at((slot + (i + 0.5) / plan.instants) * options.slot_duration));
            const auto render_row = [&](int row) {
                for (int col = 0; col < shape.cols; ++col) {
                    const Vec2 corner{
                        static_cast<float>(col) - 0.5F * static_cast<float>(shape.cols),
                        static_cast<float>(row) - 0.5F * static_cast<float>(shape.rows)};
                    const Rgb light = integrate_pixel(instants, plan, corner, pixel_size);
                    store(light, shape, row_major(row, col, shape.cols), frame);
                }
            };
            constexpr int kBand = 16;  // rows; of 4096 columns in about a second
            for (int row = 0; row < shape.rows; row += kBand) {
                const int end = std::min(row + kBand, shape.rows);
                parallel_for(row, end, render_row);
                if (!progress(static_cast<double>(end) / shape.rows)) return false;
            }
            return true;
        },
        impl_->model);
}

}  // namespace stipple
