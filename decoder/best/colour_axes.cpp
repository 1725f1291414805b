#include "decoder/best/patch_kernels.h"

#include <Eigen/Eigenvalues>

namespace stipple {

ColourMatrix principal_colour_axes(const ColourMatrix& covariance) noexcept {
    using Rows = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
    const Eigen::SelfAdjointEigenSolver<Rows> solver(Eigen::Map<const Rows>(covariance[0].data()));
    ColourMatrix axes;
    Eigen::Map<Rows>(axes[0].data()) = solver.eigenvectors();
    return axes;
}

}  // namespace stipple
