#include "io/opencv_quiet.h"

#include <cstdlib>
#include <opencv2/core/utils/logger.hpp>

namespace stipple {

void silence_opencv() {
    static const bool silenced = [] {
        cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
        // Read once by OpenCV when it first loads FFmpeg; -8 is AV_LOG_QUIET.
        setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", 0);
        return true;
    }();
    static_cast<void>(silenced);
}

}  // namespace stipple
