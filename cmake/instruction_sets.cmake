# Besides the solver for every x86-64 processor, there is one for processors with AVX2, which is chosen at run time.
# Only releases have it, because it doubles the compile time of the solvers. Sanitizer builds do not have it, because
# their tables refer to the object files as they were before merging.
include(CheckCXXSourceCompiles)
include(CMakeDependentOption)
set(CMAKE_REQUIRED_FLAGS "-mavx2 -mfma")
check_cxx_source_compiles("int main() { return __builtin_cpu_supports(\"avx2\") ? 0 : 1; }"
  RIGCAL_COMPILER_KNOWS_AVX2)
unset(CMAKE_REQUIRED_FLAGS)
cmake_dependent_option(RIGCAL_AVX2 "A second solver for processors with AVX2" ON
  "CMAKE_BUILD_TYPE STREQUAL Release;RIGCAL_COMPILER_KNOWS_AVX2;CMAKE_OBJCOPY;CMAKE_LINKER;NOT RIGCAL_SANITIZE" OFF)

# Merges an object library with one source into an object file in which all symbols are local, except those that match
# `keep`. Otherwise, inline functions compiled for AVX2 could replace those of other objects and run on processors
# without AVX2.
function(rigcal_private_object library keep result)
  set(merged ${CMAKE_CURRENT_BINARY_DIR}/${library}.merged.o)
  set(private ${CMAKE_CURRENT_BINARY_DIR}/${library}.private.o)
  add_custom_command(OUTPUT ${private}
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation -o ${merged} $<TARGET_OBJECTS:${library}>
    COMMAND ${CMAKE_OBJCOPY} --wildcard "--keep-global-symbol=${keep}" ${merged} ${private}
    DEPENDS ${library} $<TARGET_OBJECTS:${library}>
    VERBATIM)
  set(${result} ${private} PARENT_SCOPE)
endfunction()
