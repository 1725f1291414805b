# Read by cpack: who the packages are from, and the packages of the libraries that are loaded at their first use.
cmake_policy(VERSION 3.25)
if(DEFINED ENV{DEBEMAIL})
    set(name "Stipple authors")
    if(DEFINED ENV{DEBFULLNAME})
        set(name $ENV{DEBFULLNAME})
    endif()
    set(CPACK_PACKAGE_CONTACT "${name} <$ENV{DEBEMAIL}>")
endif()

foreach(library IN LISTS CPACK_STIPPLE_LATE_LIBRARIES)
    file(REAL_PATH ${library} file)  # libavcodec.so.59.37.100
    execute_process(COMMAND dpkg-query --search ${file} OUTPUT_VARIABLE owner COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCH "^[^:]+" owner "${owner}")
    string(PREPEND CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "${owner}, ")
endforeach()
