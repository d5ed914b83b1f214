# Headers that nearly every source reads, parsed once: it halves the time of a first build. Sources
# include what they use all the same. A compiler cache does better for later builds, and does not go
# with it.

option(VMECH_PRECOMPILE "parse the most used headers once" ${VMECH_PRECOMPILE_DEFAULT})
set(vmech_common_headers
  <Eigen/Cholesky> <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath> <cstdint> <filesystem>
  <functional> <limits> <memory> <optional> <span> <stdexcept> <string>
  <string_view> <utility> <vector>)

# vmech_add_precompiled(<name> [PROGRAMS] HEADERS ... LIBS ...): headers precompiled for all targets
# with the same options, libraries or PROGRAMS.
function(vmech_add_precompiled name)
  cmake_parse_arguments(ARG "PROGRAMS" "" "HEADERS;LIBS" ${ARGN})
  set(source ${PROJECT_BINARY_DIR}/precompiled/${name}.cc)
  file(CONFIGURE OUTPUT ${source} CONTENT "int main() {}\n")
  if(ARG_PROGRAMS)
    add_executable(vmech_precompiled_${name} EXCLUDE_FROM_ALL ${source})
  else()
    add_library(vmech_precompiled_${name} OBJECT EXCLUDE_FROM_ALL ${source})
  endif()
  target_link_libraries(vmech_precompiled_${name} PRIVATE
    Eigen3::Eigen vmech_settings ${ARG_LIBS})
  target_compile_definitions(vmech_precompiled_${name} PRIVATE
    EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_precompile_headers(vmech_precompiled_${name} PRIVATE ${vmech_common_headers}
                            ${ARG_HEADERS})
endfunction()

# vmech_precompile(<target> <name>): the target reads the headers precompiled as <name>.
function(vmech_precompile target name)
  if(VMECH_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM vmech_precompiled_${name})
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "EXECUTABLE")
      # g++ 12 takes a header that is precompiled for one of the project's own, and warns of what it
      # sees inside std::string and in GoogleTest's macros.
      target_compile_options(${target} PRIVATE
                             -Wno-array-bounds -Wno-stringop-overflow -Wno-dangling-else)
    endif()
  endif()
endfunction()

if(VMECH_PRECOMPILE)
  vmech_add_precompiled(library HEADERS <fmt/format.h> LIBS fmt::fmt vmech_kernel_settings)
  vmech_add_precompiled(programs PROGRAMS HEADERS <CLI/CLI.hpp> <fmt/format.h>
                        LIBS fmt::fmt CLI11::CLI11)
endif()
