# What a build may choose, and the compile settings that every target shares.

option(VMECH_BUILD_TESTS "build the tests and benchmarks" ${PROJECT_IS_TOP_LEVEL})
option(VMECH_BUILD_C "build libvmech_c, the library for C" ${PROJECT_IS_TOP_LEVEL})
option(VMECH_BUILD_PYTHON "build the Python module" ${PROJECT_IS_TOP_LEVEL})
option(VMECH_BUILD_NOTEBOOKS "build the chapters of notebooks_cpp" ${PROJECT_IS_TOP_LEVEL})
option(VMECH_LINT "run clang-format, clang-tidy and the text rules as tests"
       ${PROJECT_IS_TOP_LEVEL})
option(VMECH_WARNINGS_AS_ERRORS "treat warnings as errors" OFF)
option(VMECH_FORBID_MALLOC "make Eigen assert on allocations where they are forbidden" OFF)
option(VMECH_POISON "let tests fill with NaN what a call makes stale (base/poison.h)" OFF)
option(VMECH_REQUIRE_PACKAGES "fail where a package is absent, rather than leave out what needs it"
       OFF)
option(VMECH_BUILD_FUZZERS "build the fuzz targets; needs clang" OFF)
set(VMECH_SANITIZE "" CACHE STRING "sanitizers, for example address,undefined")
set(VMECH_ARCH "x86-64-v3" CACHE STRING
    "-march of the library; empty for the compiler's own choice")

# vmech_built_with(<name> <version>): a package that the program may do without is built in; for
# `vmech --version`.
function(vmech_built_with name version)
  set_property(GLOBAL APPEND PROPERTY VMECH_BUILT_WITH "${name} ${version}")
endfunction()

# vmech_leave_out(<part> <Debian package> [<name>]): says that a part is not built, nor tested, for
# want of a package; an error where all are required. One that `vmech --version` speaks of is named.
function(vmech_leave_out part package)
  if(VMECH_REQUIRE_PACKAGES)
    message(FATAL_ERROR "${part} needs ${package}, which was not found: install it, or set "
                        "VMECH_REQUIRE_PACKAGES=OFF to do without")
  endif()
  message(STATUS "${part} is off, ${package} was not found")
  foreach(name ${ARGN})
    set_property(GLOBAL APPEND PROPERTY VMECH_BUILT_WITHOUT "${name} (${package})")
  endforeach()
endfunction()

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(VMECH_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/vmech)

find_program(VMECH_CCACHE ccache)
if(VMECH_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VMECH_CCACHE})
endif()
set(VMECH_PRECOMPILE_DEFAULT ON)
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(VMECH_PRECOMPILE_DEFAULT OFF)
endif()

# vmech_settings: what every source of this tree is compiled with; never exported.
add_library(vmech_settings INTERFACE)
target_compile_options(vmech_settings INTERFACE -Wall -Wextra -Wpedantic -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 warns of overlapping copies inside std::string's operator+ (its bug 105651).
  target_compile_options(vmech_settings INTERFACE -Wno-restrict)
endif()
if(VMECH_WARNINGS_AS_ERRORS)
  target_compile_options(vmech_settings INTERFACE -Werror)
endif()
if(VMECH_SANITIZE)
  target_compile_options(vmech_settings INTERFACE -fsanitize=${VMECH_SANITIZE}
                         -fno-omit-frame-pointer -fno-sanitize-recover=all)
  # The sanitizer's dlopen looks where the sanitizer's own library says (RUNPATH), but for the older
  # RPATH of the program.
  target_link_options(vmech_settings INTERFACE -fsanitize=${VMECH_SANITIZE}
                      LINKER:--disable-new-dtags)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Instrumented code hides from g++ what is initialised: it warns inside <regex>.
    target_compile_options(vmech_settings INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
if(VMECH_BUILD_FUZZERS)
  target_compile_options(vmech_settings INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(VMECH_FORBID_MALLOC)
  target_compile_definitions(vmech_settings INTERFACE EIGEN_RUNTIME_NO_MALLOC)
endif()

# vmech_kernel_settings: the arithmetic of the library itself. The alignment that Eigen assumes is
# pinned (VmechModule.cmake), so that code compiled with and without AVX can be mixed: 16 bytes for
# members and the stack, 64 for the heap. Eigen never aligns the heap to less than its widest vector
# and pads there by hand, so 16 would free in one file what another padded.
add_library(vmech_kernel_settings INTERFACE)
if(VMECH_ARCH AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  target_compile_options(vmech_kernel_settings INTERFACE -march=${VMECH_ARCH})
endif()
target_compile_options(vmech_kernel_settings INTERFACE -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 sees 32-byte stores into 3-vectors in code of Eigen's that is never reached.
  target_compile_options(vmech_kernel_settings INTERFACE -Wno-array-bounds -Wno-stringop-overflow)
endif()
if(VMECH_ARCH MATCHES "x86-64-v[34]" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU"
   AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12)
  # Copies in the registers that are computed with: one that was copied by halves is waited for
  # where it is loaded as a whole.
  target_compile_options(vmech_kernel_settings INTERFACE -mmove-max=256 -mstore-max=256)
endif()

# vmech_inline_kernels: for modules whose kernels are many small functions on 3-vectors, which g++
# would rather call than inline: 15 to 20 % of the time of a pose goes into passing them through
# memory.
add_library(vmech_inline_kernels INTERFACE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  foreach(limit max-inline-insns-auto=400 max-inline-insns-single=1000 inline-unit-growth=1000
                large-function-growth=5000 large-stack-frame-growth=5000)
    target_compile_options(vmech_inline_kernels INTERFACE $<$<CONFIG:Release>:--param=${limit}>)
  endforeach()
endif()
