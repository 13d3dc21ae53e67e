# Builds the model as a WebAssembly module for pages that simulate (model/wasm, report/live). The module has the sources
# of the model library without FMI, with the solvers for every processor and without sensitivities. clang compiles it
# for a machine without an operating system, which needs three Debian packages (scripts/setup). If one is missing, no
# module is built, and `rigcal --version` says so.
option(RIGCAL_WASM "Make the model for pages that simulate, where its compiler is there" ON)
if(NOT RIGCAL_WASM OR NOT CMAKE_BUILD_TYPE STREQUAL "Release")
  return()
endif()
find_program(RIGCAL_WASM_CLANG NAMES clang++ clang++-19 clang++-14)
# zopfli writes the gzip format, 5 % smaller than gzip.
find_program(RIGCAL_GZIP NAMES zopfli gzip)
set(compress ${RIGCAL_GZIP})
if(RIGCAL_GZIP MATCHES "gzip$")
  list(APPEND compress -9 -n -k -f)
endif()
set(wasm ${CMAKE_CURRENT_BINARY_DIR}/wasm)
# This folder has only the headers of these packages. Their usual folder also has the headers of the machine's own C
# library, which must not be used.
foreach(package boost fmt)
  find_path(RIGCAL_WASM_${package} ${package} REQUIRED)
  file(MAKE_DIRECTORY ${wasm}/include)
  file(CREATE_LINK ${RIGCAL_WASM_${package}}/${package} ${wasm}/include/${package} SYMBOLIC)
endforeach()
get_target_property(eigen Eigen3::Eigen INTERFACE_INCLUDE_DIRECTORIES)
# WebAssembly does not unwind the stack: an exception ends the module (model/wasm/module.cpp).
set(compile ${RIGCAL_WASM_CLANG} --target=wasm32-wasi -std=c++20 -O2 -DNDEBUG -fno-math-errno
  -I${PROJECT_SOURCE_DIR} -isystem ${eigen} -isystem ${wasm}/include -DFMT_HEADER_ONLY -DFMT_EXCEPTIONS=0 -DEIGEN_NO_EXCEPTIONS
  -DEIGEN_DONT_VECTORIZE)
# The usual stack of 64 kB is too small for the two-chamber rig with all its terms. It comes first in memory, so that an
# overflow ends the module instead of changing its data.
set(link ${RIGCAL_WASM_CLANG} --target=wasm32-wasi -mexec-model=reactor -O2 -Wl,--strip-all -Wl,--gc-sections
  -Wl,--stack-first -Wl,-z,stack-size=1048576)

# Tests once whether the toolchain is complete: compiles and links the headers that the model includes, together with
# the replacements for exceptions.
if(RIGCAL_WASM_CLANG AND RIGCAL_GZIP AND NOT RIGCAL_WASM_COMPILES)
  file(WRITE ${wasm}/try.cpp "#include <fmt/format.h>
#include <Eigen/LU>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <stdexcept>
#include <typeinfo>
extern \"C\" void* __cxa_allocate_exception(std::size_t size) noexcept { return ::operator new(size); }
extern \"C\" [[noreturn]] void __cxa_throw(void*, std::type_info*, void (*)(void*)) { __builtin_trap(); }
extern \"C\" __attribute__((export_name(\"tried\"))) int tried(double x) {
  if (x < 0.0) throw std::invalid_argument(fmt::format(\"{:g}\", x));
  return 1;
}
")
  execute_process(COMMAND ${compile} -c ${wasm}/try.cpp -o ${wasm}/try.o RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(NOT failed)
    execute_process(COMMAND ${link} ${wasm}/try.o -o ${wasm}/try.wasm RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  endif()
  if(NOT failed)
    set(RIGCAL_WASM_COMPILES ON CACHE INTERNAL "clang has all that it needs for WebAssembly")
  endif()
endif()
if(NOT RIGCAL_WASM_COMPILES)
  message(STATUS "No model for pages: clang, lld, wasi-libc, libc++ and compiler-rt for WebAssembly are not all here")
  return()
endif()

set(objects)

# Each page carries the module, which has a limit of 0.3 MB. The largest solvers are compiled for size: 293 kB.
set(small LinkagePlant_8 LoadPressurePlant_10 TwoChamberPlant_12)

# rigcal_wasm_object(name source definition...)
function(rigcal_wasm_object name source)
  set(object ${wasm}/${name}.o)
  list(TRANSFORM ARGN PREPEND -D)
  if(name IN_LIST small)
    list(APPEND ARGN -Os)
  endif()
  add_custom_command(OUTPUT ${object}
    COMMAND ${CMAKE_CXX_COMPILER_LAUNCHER} ${compile} ${ARGN} -MD -MF ${object}.d -MT ${object} -c ${source} -o ${object}
    DEPENDS ${source} DEPFILE ${object}.d COMMENT "WebAssembly: ${name}" VERBATIM)
  set(objects ${objects} ${object} PARENT_SCOPE)
endfunction()

get_target_property(sources rigcal_model SOURCES)
list(FILTER sources INCLUDE REGEX "^[a-z_/]+\\.cpp$")
list(FILTER sources EXCLUDE REGEX "^fmi/")
rigcal_solver_list(base solvers)
foreach(source IN LISTS sources ITEMS wasm/module.cpp)
  get_filename_component(name ${source} NAME_WE)
  set(definitions)
  if(source STREQUAL "simulate.cpp")
    set(definitions "RIGCAL_base_SOLVERS=${solvers}")
  endif()
  rigcal_wasm_object(${name} ${CMAKE_CURRENT_SOURCE_DIR}/${source} ${definitions})
endforeach()
get_property(plants GLOBAL PROPERTY RIGCAL_base_PLANTS)
list(REMOVE_DUPLICATES plants)
foreach(plant IN LISTS plants)
  get_property(header GLOBAL PROPERTY RIGCAL_HEADER_OF_${plant})
  get_property(sizes GLOBAL PROPERTY RIGCAL_base_SIZES_OF_${plant})
  foreach(states IN LISTS sizes)
    # There are no widths, because the module computes no sensitivities.
    rigcal_wasm_object(${plant}_${states} ${CMAKE_CURRENT_SOURCE_DIR}/solver/simulate_sized.cpp RIGCAL_PLANT=${plant}
      "RIGCAL_PLANT_HEADER=\"${header}\"" RIGCAL_STATES=${states} RIGCAL_INSTRUCTION_SET=base RIGCAL_WIDTHS=0)
  endforeach()
endforeach()
add_custom_command(OUTPUT ${wasm}/model.wasm.gz
  COMMAND ${link} ${objects} -o ${wasm}/model.wasm
  COMMAND ${compress} ${wasm}/model.wasm
  DEPENDS ${objects} COMMENT "WebAssembly: the module" VERBATIM)
add_custom_target(rigcal_wasm DEPENDS ${wasm}/model.wasm.gz)
set_property(GLOBAL PROPERTY RIGCAL_LIVE_MODULE ${wasm}/model.wasm.gz)
