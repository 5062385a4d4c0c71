# manoscope_module(<name> SOURCES ... [TESTS ...] [DEPENDS ...] [LINK ...] [PRIVATE_LINK ...])
#
# One static library `manoscope_<name>` from a folder of src/manoscope, and one test program
# `<name>_test` from its x_test.cpp files. DEPENDS names other modules; LINK and PRIVATE_LINK name
# outside libraries, the latter for libraries whose headers stay in .cpp files.
include(GoogleTest)

add_library(manoscope_options INTERFACE)
target_compile_options(manoscope_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off)
# g++ 12 warns of overlaps inside std::string's operator+ that cannot happen (GCC bug 105651).
target_compile_options(manoscope_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# numerics/lanes.hpp inlines all that takes a vector: how one is handed over does not matter.
target_compile_options(manoscope_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
if(MANOSCOPE_WARNINGS_AS_ERRORS)
  target_compile_options(manoscope_options INTERFACE -Werror)
endif()
if(MANOSCOPE_ASSERTS)
  target_compile_definitions(manoscope_options INTERFACE MANOSCOPE_ASSERTS=1)
endif()
if(MANOSCOPE_SANITIZE)
  target_compile_options(manoscope_options INTERFACE -fsanitize=address,undefined
                         -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(manoscope_options INTERFACE -fsanitize=address,undefined)
endif()
if(MANOSCOPE_FUZZ)
  target_compile_options(manoscope_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
# Results must not depend on the number of threads that Eigen finds.
target_compile_definitions(manoscope_options INTERFACE EIGEN_DONT_PARALLELIZE)

# The entry of every test program, and the one object that knows places on this machine.
function(manoscope_test_main)
  if(TARGET manoscope_test_main)
    return()
  endif()
  add_library(manoscope_test_main OBJECT ${CMAKE_SOURCE_DIR}/tests/support/test_main.cpp)
  target_include_directories(manoscope_test_main PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(manoscope_test_main PUBLIC GTest::gtest PRIVATE manoscope_options)
  target_compile_definitions(manoscope_test_main PRIVATE
    MANOSCOPE_SHARED_DIR="${MANOSCOPE_SHARED_DIR}"
    MANOSCOPE_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    MANOSCOPE_PYTHON="${MANOSCOPE_PYTHON}"
    MANOSCOPE_PROGRAM="${CMAKE_BINARY_DIR}/manoscope")
endfunction()

function(manoscope_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  manoscope_test_main()
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LINK} manoscope_test_main manoscope_options)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  if(TARGET manoscope-hdf5-reader)  # of module io; what lies above may read HDF5 through it
    add_dependencies(${name} manoscope-hdf5-reader)
  endif()
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES TIMEOUT 600)
endfunction()

function(manoscope_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;TESTS;DEPENDS;LINK;PRIVATE_LINK" ${ARGN})
  set(library manoscope_${name})
  add_library(${library} STATIC ${ARG_SOURCES})
  target_include_directories(${library} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  list(TRANSFORM ARG_DEPENDS PREPEND manoscope_)
  target_link_libraries(${library} PUBLIC ${ARG_DEPENDS} ${ARG_LINK}
                        PRIVATE manoscope_options ${ARG_PRIVATE_LINK})
  if(MANOSCOPE_TESTS AND ARG_TESTS)
    manoscope_test(${name}_test SOURCES ${ARG_TESTS} LINK ${library})
  endif()
endfunction()
