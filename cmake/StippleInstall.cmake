# cmake --install: the program, its configurations, and the libraries for other projects (docs/library.md):
# find_package(stipple) gives the shared stipple::stipple, COMPONENTS decoder the static stipple::decoder.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/stipple)
set(header_dir ${CMAKE_INSTALL_INCLUDEDIR}/stipple)

install(TARGETS stipple COMPONENT program)
install(TARGETS stipple_opencv LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/stipple COMPONENT program)
install(DIRECTORY config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/stipple/config COMPONENT program)

# Manual pages and completions come from the program itself, which knows its options.
install(CODE "
    set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
    file(MAKE_DIRECTORY \"\${share}/man\")
    execute_process(COMMAND ${CMAKE_BINARY_DIR}/stipple manual --force \"\${share}/man/man1\"
                    COMMAND_ERROR_IS_FATAL ANY)
    foreach(shell bash:bash-completion/completions/stipple zsh:zsh/vendor-completions/_stipple
                  fish:fish/vendor_completions.d/stipple.fish)
        string(REGEX MATCH \"^[^:]+\" name \"\${shell}\")
        string(REGEX REPLACE \"^[^:]+:\" \"\" file \"\${shell}\")
        cmake_path(GET file PARENT_PATH folder)
        file(MAKE_DIRECTORY \"\${share}/\${folder}\")
        execute_process(COMMAND ${CMAKE_BINARY_DIR}/stipple completion \${name}
                        OUTPUT_FILE \"\${share}/\${file}\" COMMAND_ERROR_IS_FATAL ANY)
    endforeach()" COMPONENT program)

# An export set for each module, so that who asks for one needs the packages of that one only.
set(stipple_links)
foreach(module IN LISTS STIPPLE_MODULES)
    get_target_property(links stipple_${module} LINK_LIBRARIES)
    list(JOIN links " " links)
    string(APPEND stipple_links "set(stipple_links_of_${module} ${links})\n")
    set_target_properties(stipple_${module} PROPERTIES EXPORT_NAME ${module})
    target_compile_features(stipple_${module} INTERFACE cxx_std_20)
    target_include_directories(stipple_${module} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    install(TARGETS stipple_${module} EXPORT stipple_${module} COMPONENT libraries
            FILE_SET HEADERS DESTINATION ${header_dir}/detail COMPONENT libraries
            FILE_SET headers_without_source DESTINATION ${header_dir}/detail COMPONENT libraries)
    install(EXPORT stipple_${module} NAMESPACE stipple:: FILE ${module}.cmake DESTINATION ${package_dir}
            COMPONENT libraries)
endforeach()

install(TARGETS stipple_shared EXPORT stipple_shared
        LIBRARY COMPONENT shared NAMELINK_COMPONENT libraries
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT libraries)
target_include_directories(stipple_shared INTERFACE $<INSTALL_INTERFACE:${header_dir}/detail>)
install(EXPORT stipple_shared NAMESPACE stipple:: FILE shared.cmake DESTINATION ${package_dir} COMPONENT libraries)

configure_package_config_file(cmake/stippleConfig.cmake.in ${CMAKE_BINARY_DIR}/stippleConfig.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/stippleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/stippleConfig.cmake ${CMAKE_BINARY_DIR}/stippleConfigVersion.cmake
              cmake/FindOpenCV.cmake
        DESTINATION ${package_dir} COMPONENT libraries)
install(FILES cmake/package_config_dir.cpp.in DESTINATION ${package_dir} RENAME package_config_dir.cpp
        COMPONENT libraries)

# What stipple.pc.in names: the way from its folder to the prefix.
string(REGEX REPLACE "[^/]+" ".." stipple_up "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
configure_file(cmake/stipple.pc.in stipple.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/stipple.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT libraries)
