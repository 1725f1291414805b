# What Debian's policy wants in each package beside the installed files: a copyright file, changelogs, compressed
# manual pages, no debugging symbols (12.5, 12.7, 12.1, 10.1). cpack runs it before it packs the files.
cmake_policy(VERSION 3.25)
set(source ${CPACK_STIPPLE_SOURCE_DIR})
set(gzip gzip --best --no-name --force)
set(strip strip --remove-section=.comment --remove-section=.note)

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
    string(TOUPPER ${component} key)
    set(share ${CPACK_TEMPORARY_DIRECTORY}/${component}/usr/share)
    set(doc ${share}/doc/${CPACK_DEBIAN_${key}_PACKAGE_NAME})
    configure_file(${source}/cmake/packages/copyright ${doc}/copyright COPYONLY)
    configure_file(${source}/CHANGELOG.md ${doc}/changelog COPYONLY)
    string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # SOURCE_DATE_EPOCH, if it is set
    file(WRITE ${doc}/changelog.Debian
        "${CPACK_PACKAGE_NAME} (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium\n\n"
        "  * Packages of version ${CPACK_PACKAGE_VERSION}; its changes are in changelog.gz.\n\n"
        " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
    file(GLOB pages ${share}/man/man1/*.1)
    execute_process(COMMAND ${gzip} ${doc}/changelog ${doc}/changelog.Debian ${pages} COMMAND_ERROR_IS_FATAL ANY)
    file(GLOB_RECURSE archives ${share}/../lib/*.a)
    file(GLOB_RECURSE binaries ${share}/../bin/* ${share}/../lib/*.so ${share}/../lib/*.so.*.*.*)
    list(FILTER binaries EXCLUDE REGEX "libstipple[.]so$")  # a link
    if(archives)
        execute_process(COMMAND ${strip} --strip-debug --enable-deterministic-archives ${archives}
                        COMMAND_ERROR_IS_FATAL ANY)
    endif()
    if(binaries)
        execute_process(COMMAND ${strip} ${binaries} COMMAND_ERROR_IS_FATAL ANY)
    endif()
endforeach()

file(GLOB examples ${source}/docs/examples/*.cpp)
file(COPY ${source}/docs/examples/CMakeLists.txt ${examples}
     DESTINATION ${CPACK_TEMPORARY_DIRECTORY}/libraries/usr/share/doc/libstipple-dev/examples)
if("python" IN_LIST CPACK_COMPONENTS_ALL)
    file(COPY ${source}/docs/examples/notebooks
         DESTINATION ${CPACK_TEMPORARY_DIRECTORY}/python/usr/share/doc/python3-stipple/examples)
endif()
