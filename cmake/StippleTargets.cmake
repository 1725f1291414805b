# Targets shared by all modules: the same warnings, floating-point rules and header checks.

# Same bits everywhere: no contraction to FMA, no reassociation (docs/style.md, "Numbers").
add_compile_options(-ffp-contract=off)
add_compile_options(-ffile-prefix-map=${CMAKE_SOURCE_DIR}=.)  # the same binaries from any folder
# libFuzzer is guided by the branches that the modules take, so they count them.
set(stipple_counted $<$<BOOL:${STIPPLE_FUZZ}>:-fsanitize=fuzzer-no-link>)

# For what has no inner loop: a short build rather than a fast program.
set(STIPPLE_SHORT_BUILD
    -O1
    # g++ 12 misjudges concatenated texts at -O1.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds> $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)
# The same for programs: the sanitizers see little of them, but all of the tests of modules.
set(STIPPLE_SHORTEST_BUILD ${STIPPLE_SHORT_BUILD} $<$<CONFIG:Debug>:-O0>)

# What nearly every source includes, read once. Presets that check includes do without: dev and tidy.
add_compile_options(-pthread)  # as some packages ask for; all that shares a precompiled header must agree
file(TOUCH ${CMAKE_BINARY_DIR}/precompiled.cpp)
add_library(stipple_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
target_link_libraries(stipple_precompiled PRIVATE fmt::fmt)
target_compile_options(stipple_precompiled PRIVATE ${stipple_counted})
set(stipple_precompiled_headers
    <fmt/format.h> <algorithm> <cmath> <filesystem> <functional> <memory> <optional> <span> <string> <vector>)
target_precompile_headers(stipple_precompiled PRIVATE ${stipple_precompiled_headers})
set_target_properties(stipple_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
target_compile_options(stipple_precompiled PRIVATE -fno-semantic-interposition)

# stipple_module(NAME SOURCES a.cpp ... HEADERS a.h ... [PUBLIC lib ...] [PRIVATE lib ...] [OPTIONS flag ...])
# One library per module, built from the folder of the same name. A header of whose name there is a
# source is proved to compile alone by that source, which includes it first (tests/checks/headers.py),
# where nothing is precompiled; CMAKE_VERIFY_INTERFACE_HEADER_SETS compiles each of the others alone.
function(stipple_module name)
    cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE;OPTIONS" ${ARGN})
    add_library(stipple_${name} STATIC ${arg_SOURCES})
    target_compile_options(stipple_${name} PRIVATE ${stipple_counted})
    if(arg_OPTIONS)  # other options need a precompiled header of their own
        target_compile_options(stipple_${name} PRIVATE ${arg_OPTIONS})
        target_precompile_headers(stipple_${name} PRIVATE ${stipple_precompiled_headers})
    else()
        target_precompile_headers(stipple_${name} REUSE_FROM stipple_precompiled)
    endif()
    list(TRANSFORM arg_SOURCES REPLACE "[.]cpp$" ".h" OUTPUT_VARIABLE proved)
    set(alone ${arg_HEADERS})
    list(REMOVE_ITEM alone ${proved})
    target_sources(stipple_${name} PUBLIC
        FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${arg_HEADERS}
        FILE_SET headers_without_source TYPE HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${alone})
    set_target_properties(stipple_${name} PROPERTIES
        INTERFACE_HEADER_SETS_TO_VERIFY headers_without_source)
    target_link_libraries(stipple_${name} PUBLIC ${arg_PUBLIC} PRIVATE fmt::fmt ${arg_PRIVATE})
    # For the shared library and the Python module. Nobody replaces a function of them at run time, so calls
    # within them stay direct and may be inlined, as in a program.
    set_target_properties(stipple_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(stipple_${name} PRIVATE -fno-semantic-interposition)
endfunction()

# stipple_verify_headers(FOLDER ... LIBS lib ...): where headers are compiled one at a time, those of
# programs, tests and benchmarks are too.
function(stipple_verify_headers)
    cmake_parse_arguments(arg "" "" "LIBS" ${ARGN})
    list(TRANSFORM arg_UNPARSED_ARGUMENTS REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/\\1/*.h")
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${arg_UNPARSED_ARGUMENTS})
    if(NOT CMAKE_VERIFY_INTERFACE_HEADER_SETS OR NOT headers)
        return()
    endif()
    add_library(stipple_inner_headers INTERFACE)
    target_sources(stipple_inner_headers INTERFACE FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR}
                                                   FILES ${headers})
    target_link_libraries(stipple_inner_headers INTERFACE ${arg_LIBS})
endfunction()

# stipple_test(MODULE [LABEL label] [SHARDS n] [APART filter [APART_LABEL label]] [PART filter PART_LABEL label]
# file_test.cpp ...): one executable MODULE_test, run whole, or as n parts that run side by side. Tests that need a
# process of their own match the GoogleTest filter APART: each is a ctest entry. Those that match the filter PART
# take long: they are one entry, with that label and PART_LABEL. Long entries begin early (COST).
function(stipple_test module)
    cmake_parse_arguments(arg "" "SHARDS;APART;APART_LABEL;PART;PART_LABEL;LABEL" "" ${ARGN})
    add_executable(${module}_test ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${module}_test PRIVATE stipple_test_support stipple_test_main)
    target_precompile_headers(${module}_test REUSE_FROM stipple_test_main)
    set(results ${CMAKE_BINARY_DIR}/test_results)
    if(arg_APART)
        gtest_discover_tests(${module}_test DISCOVERY_TIMEOUT 60 TEST_FILTER "${arg_APART}" XML_OUTPUT_DIR ${results}
                             PROPERTIES TIMEOUT 600 LABELS "${arg_LABEL}${arg_APART_LABEL}")
    endif()
    if(arg_APART STREQUAL "*")
        return()
    endif()
    if(arg_PART)
        set(name ${module}_test_${arg_PART_LABEL})
        add_test(NAME ${name} COMMAND ${module}_test --gtest_filter=${arg_PART} --gtest_output=xml:${results}/${name}.xml)
        set_tests_properties(${name} PROPERTIES TIMEOUT 600 LABELS "long;${arg_PART_LABEL}" COST 200)
    endif()
    if(NOT arg_SHARDS)
        set(arg_SHARDS 1)
    endif()
    foreach(shard RANGE 1 ${arg_SHARDS})
        set(name ${module}_test)
        if(arg_SHARDS GREATER 1)
            string(APPEND name _${shard}_of_${arg_SHARDS})
        endif()
        math(EXPR index "${shard} - 1")
        add_test(NAME ${name} COMMAND ${module}_test --gtest_filter=-${arg_APART}:${arg_PART}
                                                     --gtest_output=xml:${results}/${name}.xml)
        set_tests_properties(${name} PROPERTIES TIMEOUT 600 LABELS "${arg_LABEL}" COST ${arg_SHARDS}0
            ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_SHARDS};GTEST_SHARD_INDEX=${index}")
    endforeach()
endfunction()

# stipple_fuzz(NAME file.cpp LIBS lib ... [MUTATOR file.cpp]): `file.cpp` defines LLVMFuzzerTestOneInput,
# MUTATOR LLVMFuzzerCustomMutator, tests/fuzz/corpus/NAME holds its inputs. With STIPPLE_FUZZ a libFuzzer
# program, which a test runs for 5 s and scripts/fuzz for longer (an input may take 60 s: the largest
# hardware tile takes 1.4 s in a release build and 20 times that here); without, the corpus alone is replayed,
# with any compiler.
function(stipple_fuzz name source)
    cmake_parse_arguments(arg "" "MUTATOR" "LIBS" ${ARGN})
    set(corpus ${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name})
    add_executable(fuzz_${name} ${source})
    target_compile_options(fuzz_${name} PRIVATE ${stipple_counted})
    target_link_libraries(fuzz_${name} PRIVATE stipple_test_support ${arg_LIBS})
    if(STIPPLE_FUZZ)
        target_sources(fuzz_${name} PRIVATE ${arg_MUTATOR})
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
        set(found ${CMAKE_BINARY_DIR}/fuzz/${name})  # new inputs stay out of the source tree
        file(MAKE_DIRECTORY ${found})
        add_test(NAME fuzz_${name}_finds_nothing
                 COMMAND fuzz_${name} -max_total_time=5 -timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=4096
                         -artifact_prefix=${CMAKE_BINARY_DIR}/fuzz/ ${found} ${corpus})
        set_tests_properties(fuzz_${name}_finds_nothing PROPERTIES LABELS fuzz)
    else()
        target_sources(fuzz_${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/fuzz/replay_corpus.cpp)
        add_test(NAME fuzz_${name}_replays_its_corpus COMMAND fuzz_${name} ${corpus})
        set_tests_properties(fuzz_${name}_replays_its_corpus PROPERTIES LABELS fuzz TIMEOUT 120)
    endif()
endfunction()

# stipple_bench(NAME file.cpp LIBS lib ... [TESTED regex]): a Google Benchmark program, run once by the
# tests, or of it what `regex` names.
function(stipple_bench name source)
    cmake_parse_arguments(arg "" "TESTED" "LIBS" ${ARGN})
    add_executable(bench_${name} ${source})
    target_link_libraries(bench_${name} PRIVATE ${arg_LIBS} benchmark::benchmark_main)
    if(STIPPLE_TESTS)
        add_test(NAME bench_${name}_runs COMMAND bench_${name} --benchmark_min_time=0.001
                 --benchmark_filter=${arg_TESTED})
        set_tests_properties(bench_${name}_runs PROPERTIES LABELS bench TIMEOUT 300)
    endif()
endfunction()
