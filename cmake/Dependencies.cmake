# Every outside library, found once. Headers of all of them count as system headers.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(Ceres 2.1 REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(libpng REQUIRED IMPORTED_TARGET libpng)
pkg_check_modules(libtiff REQUIRED IMPORTED_TARGET libtiff-4)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)
# The library without MPI; `hdf5` alone may mean either.
pkg_check_modules(hdf5 REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(netcdf REQUIRED IMPORTED_TARGET netcdf)
pkg_check_modules(pugixml REQUIRED IMPORTED_TARGET pugixml)

find_path(UDUNITS2_INCLUDE_DIR udunits2.h PATH_SUFFIXES udunits2 REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)
add_library(manoscope_udunits2 INTERFACE)
target_include_directories(manoscope_udunits2 SYSTEM INTERFACE ${UDUNITS2_INCLUDE_DIR})
target_link_libraries(manoscope_udunits2 INTERFACE ${UDUNITS2_LIBRARY})

find_program(MANOSCOPE_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(NOT MANOSCOPE_PYTHON)
  find_program(MANOSCOPE_PYTHON NAMES python3 REQUIRED)
endif()

if(MANOSCOPE_TESTS)
  find_package(GTest REQUIRED)
endif()

# Navier-Stokes (src/navier_stokes), built only where deal.II and the sparse solvers are. Not under
# the sanitizers or the fuzzer, where the libraries' own leaks and the minutes of compiling say
# nothing of our code. deal.II's CMake package would set the compiler's flags, too: its folders and
# libraries are all that is taken, and of these what the program calls itself.
option(MANOSCOPE_NAVIER_STOKES "Build the Navier-Stokes solver where deal.II is installed" ON)
if(MANOSCOPE_NAVIER_STOKES AND NOT MANOSCOPE_SANITIZE AND NOT MANOSCOPE_FUZZ)
  find_package(deal.II 9.4 QUIET)
  if(deal.II_FOUND AND DEAL_II_WITH_MPI AND DEAL_II_WITH_PETSC)
    add_library(manoscope_dealii INTERFACE)
    target_include_directories(manoscope_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
    target_compile_definitions(manoscope_dealii INTERFACE BOOST_NO_AUTO_PTR)
    target_link_options(manoscope_dealii INTERFACE -Wl,--as-needed)
    target_link_libraries(manoscope_dealii INTERFACE ${DEAL_II_LIBRARIES_RELEASE})
    # The loader seeks each name in one library after another, in the order in which they are needed.
    # Of the two hundred behind deal.II, those of gmsh and OpenCASCADE seek all of theirs at every
    # start: named first, they find them soon, and the program starts in two thirds of the time.
    find_library(MANOSCOPE_DEALII_LIBRARY NAMES deal.ii deal_II HINTS ${DEAL_II_PATH}/lib)
    find_program(MANOSCOPE_LDD ldd)
    if(MANOSCOPE_DEALII_LIBRARY AND MANOSCOPE_LDD)
      execute_process(COMMAND ${MANOSCOPE_LDD} ${MANOSCOPE_DEALII_LIBRARY}
                      OUTPUT_VARIABLE behind_dealii ERROR_QUIET)
      string(REGEX MATCHALL "/[^ \n]*/lib(gmsh|openblas|TK[A-Za-z0-9]+)\\.so[^ \n]*"
             eager_libraries "${behind_dealii}")
      set(MANOSCOPE_NEEDED_FIRST ${MANOSCOPE_DEALII_LIBRARY} ${eager_libraries})
    endif()
  endif()
endif()
