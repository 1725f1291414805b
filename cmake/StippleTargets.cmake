# Targets shared by all modules: the same warnings, floating-point rules and header checks.

# Same bits everywhere: no contraction to FMA, no reassociation (docs/style.md, "Numbers").
add_compile_options(-ffp-contract=off)

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

# stipple_test(MODULE file_test.cpp ...): one executable tests/MODULE; every TEST is a ctest entry.
function(stipple_test module)
    add_executable(${module}_test ${ARGN})
    target_link_libraries(${module}_test PRIVATE stipple_test_support GTest::gtest_main)
    gtest_discover_tests(${module}_test DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 600)
endfunction()

# stipple_bench(NAME file.cpp LIBS lib ...): a Google Benchmark program, run once by the tests.
function(stipple_bench name source)
    cmake_parse_arguments(arg "" "" "LIBS" ${ARGN})
    add_executable(bench_${name} ${source})
    target_link_libraries(bench_${name} PRIVATE ${arg_LIBS} benchmark::benchmark_main)
    if(STIPPLE_TESTS)
        add_test(NAME bench_${name}_runs COMMAND bench_${name} --benchmark_min_time=0.001)
        set_tests_properties(bench_${name}_runs PROPERTIES LABELS bench TIMEOUT 300)
    endif()
endfunction()
