# What a project needs that uses an installed module, from what the module links: stipple_module() and
# target_link_libraries() are the only places that name packages of a module. A library that a module links
# needs a line here: the target or library; what find_dependency() is told, or for a target of
# pkg_check_modules() nothing; the pkg-config module, or a flag for the linker, or nothing.
set(stipple_libraries_known
    "Threads::Threads | Threads | -pthread"
    "dl | | -ldl"
    "fmt::fmt | fmt | fmt"
    "TBB::tbb | TBB | tbb"
    "tomlplusplus::tomlplusplus | tomlplusplus | tomlplusplus"
    "PNG::PNG | PNG | libpng"
    "TIFF::TIFF | TIFF | libtiff-4"
    "PkgConfig::OpenEXR | | OpenEXR"
    "tinyxml2::tinyxml2 | tinyxml2 | tinyxml2"
    "hwy::hwy | hwy | libhwy"
    "ZLIB::ZLIB | ZLIB | zlib"
    "OpenSSL::Crypto | OpenSSL | libcrypto"
    "Eigen3::Eigen | Eigen3 |"
    "nlohmann_json::nlohmann_json | nlohmann_json |"
    "opencv_core | OpenCV 4.6 COMPONENTS core imgproc | -lopencv_core"
    "opencv_imgproc | OpenCV 4.6 COMPONENTS core imgproc | -lopencv_imgproc"
    "PkgConfig::Aravis | | aravis-0.8")

# stipple_line_of(OUT LIBRARY MODULE): sets OUT_find and OUT_link to the second and third part of the line of
# the library.
function(stipple_line_of out library module)
    foreach(line IN LISTS stipple_libraries_known)
        string(REGEX MATCH "^([^ ]+) [|] ?(.*) ?[|] ?(.*)$" matched "${line}")
        if(CMAKE_MATCH_1 STREQUAL library)
            string(STRIP "${CMAKE_MATCH_2}" find)
            string(STRIP "${CMAKE_MATCH_3}" link)
            set(${out}_find "${find}" PARENT_SCOPE)
            set(${out}_link "${link}" PARENT_SCOPE)
            return()
        endif()
    endforeach()
    message(FATAL_ERROR "stipple_${module} links ${library}, of which cmake/StippleDependencies.cmake has no line")
endfunction()

# stipple_dependencies(MODULES PKGCONFIG FLAGS module ...): sets MODULES to lines of CMake for stippleConfig.cmake
# that set, for each module, stipple_modules_of_X, stipple_packages_of_X (arguments of find_dependency, joined by
# blanks) and stipple_pkgconfig_of_X (TARGET=MODULE); PKGCONFIG to the pkg-config modules of all, FLAGS to the
# linker flags of all.
function(stipple_dependencies out_modules out_pkgconfig out_flags)
    set(text "")
    set(all_pkgconfig)
    set(all_flags)
    foreach(module IN LISTS ARGN)
        set(modules)
        set(packages)
        set(pkgconfig)
        get_target_property(libraries stipple_${module} LINK_LIBRARIES)
        foreach(library IN LISTS libraries)
            if(library MATCHES "^stipple_(.+)$")
                list(APPEND modules ${CMAKE_MATCH_1})
                continue()
            endif()
            stipple_line_of(line ${library} ${module})
            if(line_find)
                list(APPEND packages "${line_find}")
            elseif(library MATCHES "^PkgConfig::(.+)$")
                list(APPEND pkgconfig "${CMAKE_MATCH_1}=${line_link}")
            endif()
            if(line_link MATCHES "^-")
                list(APPEND all_flags ${line_link})
            elseif(line_link)
                list(APPEND all_pkgconfig ${line_link})
            endif()
        endforeach()
        foreach(kind modules packages pkgconfig)
            list(REMOVE_DUPLICATES ${kind})
            set(quoted "")
            foreach(word IN LISTS ${kind})
                string(APPEND quoted " \"${word}\"")
            endforeach()
            string(APPEND text "set(stipple_${kind}_of_${module}${quoted})\n")
        endforeach()
    endforeach()
    list(REMOVE_DUPLICATES all_pkgconfig)
    list(REMOVE_DUPLICATES all_flags)
    list(JOIN all_pkgconfig " " all_pkgconfig)
    list(JOIN all_flags " " all_flags)
    set(${out_modules} "${text}" PARENT_SCOPE)
    set(${out_pkgconfig} "${all_pkgconfig}" PARENT_SCOPE)
    set(${out_flags} "${all_flags}" PARENT_SCOPE)
endfunction()
