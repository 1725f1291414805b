# Debian packages by CPack (scripts/package): one for each component of the installation. Their documents
# and compressed manual pages are added by packages/contents.cmake.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stipple)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
# Older than the 0.2.0-1 that Debian itself may have one day.
set(CPACK_DEBIAN_PACKAGE_RELEASE 0stipple1)
set(CPACK_PACKAGE_CONTACT "Stipple authors <stipple@example.org>")  # DEBFULLNAME, DEBEMAIL take its place
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL program shared libraries)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/cmake/packages/settings.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_SOURCE_DIR}/cmake/packages/contents.cmake)
set(CPACK_STIPPLE_SOURCE_DIR ${CMAKE_SOURCE_DIR})
set(CPACK_STIPPLE_LATE_LIBRARIES ${FFmpeg_LINK_LIBRARIES} ${Matio_LIBRARY})  # dpkg-shlibdeps does not see them

set(stipple_about "In a coded-exposure sensor each pixel opens and closes at its own times.
Stipple emulates such a sensor on footage, writes its packed sample stream,
and decodes the stream to high-speed, high-dynamic-range video.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME stipple)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "gnuplot-nox | gnuplot")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "emulator and decoder of coded-exposure image sensors
${stipple_about}
It also records cameras (GigE Vision, USB3 Vision, V4L2) and measures sensors
by EMVA 1288.

This package contains the program with its sensors and schedules.")

set(CPACK_DEBIAN_SHARED_PACKAGE_NAME libstipple${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_DEBIAN_SHARED_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_SHARED_PACKAGE_CONTROL_EXTRA ${CMAKE_SOURCE_DIR}/cmake/packages/triggers)
set(CPACK_COMPONENT_SHARED_DEPENDS program)  # its sensors, schedules and libstipple_opencv.so
set(CPACK_COMPONENT_SHARED_DESCRIPTION "coded-exposure image sensors in C++: shared library
${stipple_about}

This package contains the shared library.")

set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME libstipple-dev)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_LIBRARIES_DEPENDS shared)
set(stipple_needs
    libcpp-httplib-dev libeigen3-dev libfmt-dev libhwy-dev libopencv-core-dev libopencv-imgproc-dev libopenexr-dev libpng-dev libssl-dev
    libtbb-dev libtiff-dev libtinyxml2-dev libtomlplusplus-dev nlohmann-json3-dev zlib1g-dev)
if(STIPPLE_ARAVIS)
    list(APPEND stipple_needs libaravis-dev libusb-1.0-0-dev libxml2-dev)
endif()
list(JOIN stipple_needs ", " CPACK_DEBIAN_LIBRARIES_PACKAGE_DEPENDS)
set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION "coded-exposure image sensors in C++: development files
${stipple_about}

This package contains the headers, the static libraries, their configuration
for CMake and pkg-config, and examples.")

# A module of another Python than Debian's has no package.
if(STIPPLE_PYTHON AND Python_EXECUTABLE MATCHES "^/usr/bin/python3")
    list(APPEND CPACK_COMPONENTS_ALL python)
    math(EXPR stipple_next_minor "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-stipple)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_COMPONENT_PYTHON_DEPENDS program)  # as above, and libstipple_opencv.so
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= 3.${Python_VERSION_MINOR}~), python3 (<< 3.${stipple_next_minor}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "jupyter-notebook, python3-matplotlib")  # its examples
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
        ${CMAKE_SOURCE_DIR}/cmake/packages/postinst ${CMAKE_SOURCE_DIR}/cmake/packages/prerm)
    set(CPACK_COMPONENT_PYTHON_DESCRIPTION "coded-exposure image sensors in Python, on NumPy arrays
${stipple_about}

This package contains the Python module stipple: arrays in, arrays out.")
endif()

include(CPack)
