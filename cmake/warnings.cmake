# Warnings as a private target, so that targets that link the library do not inherit them.
add_library(rigcal_warnings INTERFACE)
target_compile_options(rigcal_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  -Wold-style-cast -Woverloaded-virtual -Wnull-dereference -Wdouble-promotion -Wimplicit-fallthrough)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # With -O2, GCC 12 reports false positives of these kinds for std::string and fixed-size Eigen.
  target_compile_options(rigcal_warnings INTERFACE -Wno-restrict -Wno-null-dereference
    -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow)
  # GCC 13 and 14 report a false positive for functions that take a temporary string and return a reference to something
  # else.
  target_compile_options(rigcal_warnings INTERFACE -Wno-dangling-reference)
endif()
# A state, rule or verdict without words does not compile (docs/decisions/0031).
target_compile_options(rigcal_warnings INTERFACE -Werror=switch)
if(RIGCAL_WERROR)
  target_compile_options(rigcal_warnings INTERFACE -Werror)
endif()
