# Finds OpenCV by its own config file where there is one, else module by module. Debian puts the
# config file into libopencv-dev, which brings every module there is (VTK, HDF5, Qt: 1.1 GB on
# disk); the modules of scripts/packages.txt alone come to 0.6 GB.
# Sets OpenCV_FOUND, OpenCV_VERSION and OpenCV_LIBS (imported targets opencv_core, ...).

find_package(OpenCV ${OpenCV_FIND_VERSION} CONFIG QUIET COMPONENTS ${OpenCV_FIND_COMPONENTS})
if(OpenCV_FOUND)
    return()
endif()

find_path(OpenCV_INCLUDE_DIR opencv2/core/version.hpp PATH_SUFFIXES opencv4)
set(OpenCV_VERSION 0)
if(OpenCV_INCLUDE_DIR)
    file(STRINGS ${OpenCV_INCLUDE_DIR}/opencv2/core/version.hpp numbers
         REGEX "#define CV_VERSION_(MAJOR|MINOR|REVISION) ")
    string(REGEX MATCHALL "[0-9]+" numbers "${numbers}")
    list(JOIN numbers . OpenCV_VERSION)
endif()

set(OpenCV_LIBS)
foreach(module IN LISTS OpenCV_FIND_COMPONENTS)
    find_library(OpenCV_${module}_LIBRARY opencv_${module})
    find_path(OpenCV_${module}_HEADER opencv2/${module}.hpp HINTS ${OpenCV_INCLUDE_DIR})
    mark_as_advanced(OpenCV_${module}_LIBRARY OpenCV_${module}_HEADER)
    if(OpenCV_${module}_LIBRARY AND OpenCV_${module}_HEADER)
        set(OpenCV_${module}_FOUND TRUE)
        if(NOT TARGET opencv_${module})
            add_library(opencv_${module} UNKNOWN IMPORTED)
            set_target_properties(opencv_${module} PROPERTIES
                IMPORTED_LOCATION ${OpenCV_${module}_LIBRARY}
                INTERFACE_INCLUDE_DIRECTORIES ${OpenCV_INCLUDE_DIR})
        endif()
        list(APPEND OpenCV_LIBS opencv_${module})
    endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV REQUIRED_VARS OpenCV_INCLUDE_DIR
                                  VERSION_VAR OpenCV_VERSION HANDLE_COMPONENTS)
