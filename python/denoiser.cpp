#include "python/denoiser.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/memory_limit.h"
#include "decoder/best/patch_denoiser.h"
#include "decoder/best/patch_matching.h"
#include "python/bindings.h"
#include "python/footage.h"
#include "python/with_gil.h"

namespace stipple::python {
namespace {

using Array = py::array_t<float, py::array::c_style>;

py::array array_of(const FluxVideo& video) {
    return as_array(std::make_unique<std::vector<float>>(video.data().begin(), video.data().end()),
                    video.shape());
}

/// Of an array (slot, plane, row, col).
FluxVideo video_of(const Array& array) {
    if (array.ndim() != 4) throw InputError("video", "has no axes (slot, plane, row, col)");
    const auto size = [&](int axis) { return static_cast<int>(array.shape(axis)); };
    FluxVideo video(size(0), {.rows = size(2), .cols = size(3), .planes = size(1)});
    std::copy_n(array.data(), video.voxels(), video.data().begin());
    return video;
}

/// What lasts as long as a block.
struct BlockMemory {
    PatchDenoiser patches;
    bool in_use = false;
    py::dict user = {};
};

/// What a denoiser in Python may ask during a call.
class DenoiserStep {
  public:
    DenoiserStep(const DenoiserInput& input, std::shared_ptr<BlockMemory> block)
        : input_(&input), block_(std::move(block)) {}

    void end() { input_ = nullptr; }
    [[nodiscard]] const DenoiserInput& input() const {
        if (input_ == nullptr) throw InputError("step", "belongs to a call that has ended");
        return *input_;
    }
    [[nodiscard]] py::dict memory() const { return block_->user; }

    /// As `best` does, with what it kept of earlier iterations.
    [[nodiscard]] FluxVideo denoise(const FluxVideo& noisy, float sigma) {
        const FluxVideo light = input().light,
                        pilot = input().pilot;  // without the GIL they may go
        if (noisy.slots() != light.slots() || noisy.shape() != light.shape())
            throw InputError("video", "has another shape than that of the step");
        if (std::exchange(block_->in_use, true))
            throw InputError("step", "is in use by another thread");
        const int iteration = input().iteration;
        const std::shared_ptr<BlockMemory> block = block_;
        FluxVideo result(noisy.slots(), noisy.shape());
        {
            const py::gil_scoped_release released;
            block->patches({iteration, sigma, light, noisy, pilot}, result);
        }
        block->in_use = false;
        return result;
    }

  private:
    const DenoiserInput* input_;
    std::shared_ptr<BlockMemory> block_;
};

void call_python(const py::object& call, const std::shared_ptr<BlockMemory>& block,
                 const DenoiserInput& input, FluxVideo& result) {
    const py::gil_scoped_acquire gil;
    const auto step = std::make_shared<DenoiserStep>(input, block);
    struct End {
        DenoiserStep& step;
        ~End() { step.end(); }
    };
    const End end{*step};
    const auto values = call(array_of(input.noisy), input.sigma, step).cast<Array>();
    if (static_cast<std::size_t>(values.size()) != result.voxels())
        throw InputError("denoiser", "its result has another size");
    std::copy_n(values.data(), result.voxels(), result.data().begin());
}

/// Without a decoding: the pilot of a pass is the result of the one before.
FluxVideo denoised(const FluxVideo& noisy, float sigma, int passes) {
    FluxVideo light(noisy.slots(), {noisy.shape().rows, noisy.shape().cols, 1});  // for motion
    for (int slot = 0; slot < noisy.slots(); ++slot)
        std::ranges::transform(noisy.frame(slot).first(light.shape().pixels()),
                               light.frame(slot).begin(), [](float z) {
                                   const float root = std::max(z, 0.0F) / 2;
                                   return root * root;
                               });
    PatchDenoiser patches({.motion_every = passes, .match_every = 1}, false);
    FluxVideo pilot = noisy;
    FluxVideo result(noisy.slots(), noisy.shape());
    for (int pass = 0; pass < passes; ++pass) {
        patches({pass, sigma, light, noisy, pilot}, result);
        std::swap(result, pilot);
    }
    return pilot;
}

py::array denoise(const Array& array, float sigma, DenoiserStep* step, int passes) {
    constexpr std::uint64_t kVoxelBytes = 40;
    check_memory(static_cast<std::uint64_t>(array.size()) * kVoxelBytes, "video", "its filter");
    const FluxVideo noisy = video_of(array);
    if (std::min(noisy.shape().rows, noisy.shape().cols) < kPatchSide)
        throw InputError(
            "video", fmt::format("has {} x {} pixels (width x height), less than a "
                                 "patch of {} x {}",
                                 noisy.shape().cols, noisy.shape().rows, kPatchSide, kPatchSide));
    if (step != nullptr) return array_of(step->denoise(noisy, sigma));
    std::optional<FluxVideo> result;
    {
        const py::gil_scoped_release released;
        result = denoised(noisy, sigma, passes);
    }
    return array_of(*result);
}

}  // namespace

DenoiserMaker python_denoiser(const py::object& call) {
    const std::shared_ptr<py::object> held = with_gil(new py::object(call));
    return [held](const CollaborativeOptions& options, bool mosaic) -> Denoiser {
        const py::gil_scoped_acquire gil;
        const auto block = with_gil(new BlockMemory{PatchDenoiser(options, mosaic)});
        return [held, block](const DenoiserInput& input, FluxVideo& result) {
            call_python(*held, block, input, result);
        };
    };
}

void bind_denoiser(py::module_& module) {
    py::class_<DenoiserStep, std::shared_ptr<DenoiserStep>>(module, "DenoiserStep",
                                                            R"(What a denoiser may ask in a call
of decode: the parameter `step` of one that has it.

iteration: of the block, from 0. memory: a dict that lasts as long as the block.
sigma: as the second argument.
light: the estimate in linear light, in places below 0. pilot: what the last call gave; in the first one the video.
Arrays are copies, with the shape of the video.)")
        .def_property_readonly("iteration",
                               [](const DenoiserStep& step) { return step.input().iteration; })
        .def_property_readonly("sigma", [](const DenoiserStep& step) { return step.input().sigma; })
        .def_property_readonly(
            "light", [](const DenoiserStep& step) { return array_of(step.input().light); })
        .def_property_readonly(
            "pilot", [](const DenoiserStep& step) { return array_of(step.input().pilot); })
        .def_property_readonly("memory", &DenoiserStep::memory);
    module.def("denoise", &denoise);
}

}  // namespace stipple::python
