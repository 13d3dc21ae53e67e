# Installs rigcal.hpp and all headers that it includes, directly or indirectly, into include/rigcal. All other headers
# are internal. Includes get the prefix rigcal/, so that a program needs no include path to folders with names such as
# common.
#
#   set(ROOT sources) set(INCLUDEDIR include) include(install_headers.cmake)   when cmake --install runs
set(destination "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${INCLUDEDIR}/rigcal")
set(waiting rigcal.hpp)
set(installed)
while(waiting)
  list(POP_FRONT waiting header)
  list(FIND installed "${header}" place)  # IN_LIST needs a policy, which install scripts do not set
  if(NOT place EQUAL -1)
    continue()
  endif()
  list(APPEND installed "${header}")
  file(READ "${ROOT}/${header}" text)
  string(REGEX MATCHALL "#include \"[^\"]+\"" included "${text}")
  list(TRANSFORM included REPLACE "#include \"([^\"]+)\"" "\\1")
  list(APPEND waiting ${included})
  string(REGEX REPLACE "#include \"" "#include \"rigcal/" text "${text}")
  file(WRITE "${destination}/${header}" "${text}")
endwhile()
list(LENGTH installed count)
message(STATUS "Installed: ${destination} (${count} headers)")
