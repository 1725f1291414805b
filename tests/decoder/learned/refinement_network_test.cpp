#include "decoder/learned/refinement_network.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "tests/decoder/learned/plain_network.h"
#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"
#include "tests/support/temporary_folder.h"

namespace stipple {
namespace {

RefinementNetwork network_of(const Tensors& tensors) {
    return RefinementNetwork::parse(safetensors_file(tensors), "net.st");
}

std::vector<float> refined(const RefinementNetwork& network, const Planes& x) {
    std::vector<float> out(index(x.rows) * index(x.cols));
    network.refine(x.values, x.rows, x.cols, out);
    return out;
}

Planes random_planes(int channels, int rows, int cols) {
    Planes planes(channels, rows, cols);
    planes.values = random_values(planes.values.size(), 0, 1, 5);
    return planes;
}

std::string error_of(const Tensors& tensors) {
    return message_of<InputError>([&] { return network_of(tensors); });
}

TEST(RefinementNetworkTest, HasTheBitsOfItsDefinition) {
    for (const NetworkSize& size :
         {NetworkSize{},
          NetworkSize{.inputs = 1, .half = 8, .quarter = 8, .eighth = 40, .blocks = 2},
          NetworkSize{.inputs = 5, .half = 24, .quarter = 16, .eighth = 16, .blocks = 3}}) {
        const Tensors tensors = random_network(size, 7);
        const RefinementNetwork network = network_of(tensors);
        EXPECT_EQ(network.inputs(), size.inputs);
        const Planes x = random_planes(size.inputs, 24, 40);
        const auto wanted = plain_network(tensors, size.blocks, x);
        for_each_simd_target(
            [&](const std::string& target) { EXPECT_EQ(refined(network, x), wanted) << target; });
    }
}

TEST(RefinementNetworkTest, PadsByTheEdgeAndCrops) {
    const Tensors tensors = random_network({}, 7);
    const RefinementNetwork network = network_of(tensors);
    for (const auto& [rows, cols] : {std::pair{1, 1}, {7, 8}, {13, 17}, {16, 3}}) {
        const Planes x = random_planes(3, rows, cols);
        Planes padded(3, (rows + 7) / 8 * 8, (cols + 7) / 8 * 8);
        for (int plane = 0; plane < 3; ++plane)
            for (int row = 0; row < padded.rows; ++row)
                for (int col = 0; col < padded.cols; ++col)
                    padded.values[padded.at(plane, row, col)] =
                        x.values[x.at(plane, std::min(row, rows - 1), std::min(col, cols - 1))];
        const auto whole = plain_network(tensors, 1, padded);
        const auto found = refined(network, x);
        for (int row = 0; row < rows; ++row)
            for (int col = 0; col < cols; ++col)
                EXPECT_EQ(found[x.at(0, row, col)], whole[padded.at(0, row, col)])
                    << rows << " x " << cols << ": " << row << ", " << col;
    }
}

TEST(RefinementNetworkTest, AnyNumberOfThreadsGivesTheSameBits) {
    const RefinementNetwork network = network_of(random_network({.blocks = 2}, 7));
    const Planes x = random_planes(3, 77, 50);
    std::vector<float> first;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        if (first.empty()) first = refined(network, x);
        EXPECT_EQ(refined(network, x), first) << threads << " threads";
    }
}

/// Of the sizes 13 inputs, widths 40, 64 and 96, 2 blocks, by hand: multiplications per pixel of
/// the half, quarter and eighth.
TEST(RefinementNetworkTest, CountsItsProducts) {
    const auto network = network_of(
        random_network({.inputs = 13, .half = 40, .quarter = 64, .eighth = 96, .blocks = 2}, 7));
    const std::int64_t half = 9 * 40 * (52 + 4 + 8 * 40);
    const std::int64_t quarter = 4 * 40 * 64 + 8 * 9 * 64 * 64 + 4 * 64 * 40;
    const std::int64_t eighth = 4 * 64 * 96 + 4 * 9 * 96 * 96 + 4 * 96 * 64;
    EXPECT_EQ(network.products(60, 80),
              64 * 80 / 4 * half + 64 * 80 / 16 * quarter + 64 * 80 / 64 * eighth);
}

TEST(RefinementNetworkTest, ReadsAFile) {
    const TemporaryFolder folder;
    const Tensors tensors = random_network({}, 7);
    const auto bytes = safetensors_file(tensors);
    write_text(folder / "net.safetensors", std::string(bytes.begin(), bytes.end()));
    const auto network = RefinementNetwork::read(folder / "net.safetensors");
    EXPECT_EQ(network.metadata().at("format"), "pt");
    const Planes x = random_planes(3, 8, 8);
    EXPECT_EQ(refined(network, x), refined(network_of(tensors), x));
}

TEST(RefinementNetworkTest, NamesAFileThatItCannotRead) {
    const TemporaryFolder folder;
    const auto error_of_file = [&](const std::string& name) {
        return message_of<InputError>([&] { return RefinementNetwork::read(folder / name); });
    };
    expect_parts(error_of_file("none.st"), {"none.st", "No such file"});
    write_text(folder / "large.st", "");
    std::filesystem::resize_file(folder / "large.st", (std::uintmax_t{256} << 20U) + 1);
    expect_parts(error_of_file("large.st"), {"large.st", "268435457 bytes"});
    write_text(folder / "text.st", "weights of a network");
    expect_parts(error_of_file("text.st"), {"text.st", "no safetensors file"});
}

TEST(RefinementNetworkTest, NamesATensorThatIsMissing) {
    const Tensors all = random_network({}, 7);
    for (const auto& [name, tensor] : all) {
        Tensors tensors = all;
        tensors.erase(name);
        expect_parts(error_of(tensors), {"net.st: tensor \"" + name + "\"", "missing"});
    }
}

TEST(RefinementNetworkTest, NamesATensorThatIsNotOfTheNetwork) {
    Tensors tensors = random_network({}, 7);
    tensors["e1.1.a.bias"] = random_tensor({16}, 1);
    expect_parts(error_of(tensors), {"net.st: tensor \"e1.1.a.bias\"", "not one of the network's"});
    tensors = random_network({.blocks = 17}, 7);
    expect_parts(error_of(tensors), {"net.st: tensor \"e1.16.a.bias\"", "not one"});
}

TEST(RefinementNetworkTest, NamesAWrongShape) {
    const Tensors all = random_network({}, 7);
    for (const auto& [name, tensor] : all) {
        Tensors tensors = all;
        auto shape = tensor.shape;
        shape.push_back(1);
        tensors[name] = {.shape = shape, .values = tensor.values};
        expect_parts(error_of(tensors),
                     {"net.st: tensor \"" + name + "\"", shape_text(shape), "shape"});
    }
}

TEST(RefinementNetworkTest, RefusesWidthsThatTheKernelsDoNotTake) {
    expect_parts(error_of(random_network({.half = 12}, 7)), {"\"i.weight\"", "multiple of 8"});
    expect_parts(error_of(random_network({.quarter = 20}, 7)), {"\"d1.weight\"", "multiple of 8"});
    expect_parts(error_of(random_network({.eighth = 264}, 7)), {"\"d2.weight\"", "up to 256"});
    expect_parts(error_of(random_network({.inputs = 33}, 7)), {"\"i.weight\"", "up to 128"});
}

}  // namespace
}  // namespace stipple
