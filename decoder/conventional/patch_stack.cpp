#include "decoder/conventional/patch_stack.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

/// Patches by rows.
using Stack = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

}  // namespace

float filter_patch_stack(std::span<float> stack, int patches, float sigma) {
    if (patches == 1) return 1;
    const auto values = static_cast<int>(std::ssize(stack)) / patches;
    Stack x = Eigen::Map<const Stack>(stack.data(), patches, values);
    const Eigen::RowVectorXf mean = x.colwise().sum() / static_cast<float>(patches);
    x.rowwise() -= mean;
    const Eigen::SelfAdjointEigenSolver<Stack> solver(x * x.transpose());
    const float variance = sigma * sigma;
    const float root =
        std::sqrt(static_cast<float>(values)) + std::sqrt(static_cast<float>(patches));
    const float limit = variance * root * root;
    Stack kept = Stack::Zero(patches, patches);
    float squares = 1;
    for (int k = 0; k < patches; ++k) {
        const float power = solver.eigenvalues()(k);
        if (!(power > limit)) continue;
        const float factor = (power - variance * static_cast<float>(values)) / power;
        kept += factor * solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
        squares += factor * factor;
    }
    x = (kept * x).eval();
    x.rowwise() += mean;
    std::copy_n(x.data(), x.size(), stack.begin());
    return squares;
}

}  // namespace stipple
