// What libstipple_opencv.so holds: decoder/portz2013/late_opencv.h.
#include <opencv2/optflow.hpp>

#include "decoder/portz2013/late_opencv.h"

extern "C" __attribute__((visibility("default"))) void stipple_tv_l1_flow(
    stipple::PlaneView<float> from, stipple::PlaneView<float> to, std::span<float> flow) {
    const auto image = [](stipple::PlaneView<float> plane) {
        return cv::Mat(plane.rows(), plane.cols(), CV_32F, plane.data());
    };
    cv::Mat result(from.rows(), from.cols(), CV_32FC2, flow.data());
    cv::optflow::DualTVL1OpticalFlow::create()->calc(image(from), image(to), result);
}
