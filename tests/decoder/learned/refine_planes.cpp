// Runs a network for refinement_network_test.py: refine_planes WEIGHTS ROWS COLS <PLANES >RESULT,
// both of floats in the machine's order of bytes.
#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/index.h"
#include "decoder/learned/refinement_network.h"

int main(int argc, char** argv) {
    const std::span arguments(argv, static_cast<std::size_t>(argc));
    if (arguments.size() != 4) return 2;
    try {
        const auto network = stipple::RefinementNetwork::read(arguments[1]);
        const int rows = std::stoi(arguments[2]);
        const int cols = std::stoi(arguments[3]);
        std::vector<float> out(stipple::row_major(rows, 0, cols));
        std::vector<float> planes(stipple::index(network.inputs()) * out.size());
        if (std::fread(planes.data(), sizeof(float), planes.size(), stdin) != planes.size())
            return 2;
        network.refine(planes, rows, cols, out);
        const bool written =
            std::fwrite(out.data(), sizeof(float), out.size(), stdout) == out.size();
        return written ? 0 : 2;
    } catch (const stipple::InputError& error) {
        std::fputs(error.what(), stderr);
        return 1;
    }
}
