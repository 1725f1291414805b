# Targets shared by all modules: the same warnings, floating-point rules and header checks.

# Same bits everywhere: no contraction to FMA, no reassociation (docs/style.md, "Numbers").
add_compile_options(-ffp-contract=off)
if(STIPPLE_FUZZ)
    # libFuzzer is guided by the branches that the modules take, so they report them.
    add_compile_options(-fsanitize=fuzzer-no-link)
endif()

# stipple_module(NAME SOURCES a.cpp ... HEADERS a.h ... [PUBLIC lib ...] [PRIVATE lib ...])
# One library per module, built from the folder of the same name. Headers are listed so that
# CMAKE_VERIFY_INTERFACE_HEADER_SETS compiles each of them alone.
function(stipple_module name)
    cmake_parse_arguments(arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE" ${ARGN})
    add_library(stipple_${name} STATIC ${arg_SOURCES})
    target_sources(stipple_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR}
                                          FILES ${arg_HEADERS})
    target_link_libraries(stipple_${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
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

# stipple_test(MODULE [LABEL label] file_test.cpp ...): one executable tests/MODULE; every TEST is a
# ctest entry.
function(stipple_test module)
    cmake_parse_arguments(arg "" "LABEL" "" ${ARGN})
    add_executable(${module}_test ${arg_UNPARSED_ARGUMENTS})
    target_link_libraries(${module}_test PRIVATE stipple_test_support GTest::gtest_main)
    gtest_discover_tests(${module}_test DISCOVERY_TIMEOUT 60
                         PROPERTIES TIMEOUT 600 LABELS "${arg_LABEL}")
endfunction()

# stipple_fuzz(NAME file.cpp LIBS lib ... [SECONDS n]): `file.cpp` defines LLVMFuzzerTestOneInput,
# tests/fuzz/corpus/NAME holds its inputs. With STIPPLE_FUZZ a libFuzzer program that a test runs
# for n seconds (default 20); without, the corpus alone is replayed, with any compiler.
function(stipple_fuzz name source)
    cmake_parse_arguments(arg "" "SECONDS" "LIBS" ${ARGN})
    if(NOT arg_SECONDS)
        set(arg_SECONDS 20)
    endif()
    set(corpus ${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name})
    add_executable(fuzz_${name} ${source})
    target_link_libraries(fuzz_${name} PRIVATE stipple_test_support ${arg_LIBS})
    if(STIPPLE_FUZZ)
        target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
        set(found ${CMAKE_BINARY_DIR}/fuzz/${name})  # new inputs stay out of the source tree
        file(MAKE_DIRECTORY ${found})
        add_test(NAME fuzz_${name}_finds_nothing
                 COMMAND fuzz_${name} -max_total_time=${arg_SECONDS} -timeout=10 -rss_limit_mb=2048
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
