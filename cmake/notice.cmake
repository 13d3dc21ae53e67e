# Writes the notices of third-party parts that the program or its output contains, and a copyright file that begins with
# rigcal's own licence: cmake -DNOTICE=... -DCOPYRIGHT=... -DROOT=... -P notice.cmake
# The texts come from Debian and npm packages. If a package is not installed, only its licence is named.
cmake_minimum_required(VERSION 3.25)
set(text "rigcal is under the MIT licence. Beside its own it holds parts of others, whose notices follow.

What it links as shared libraries comes in packages of its own, with its own notices: in the archive these are beside, in
share/doc/<package>. One of them, libcholmod (by way of Ceres), is in part under the GNU General Public License, version 2 or
later, and OpenSSL is under the Apache License 2.0: who hands the program on together with these libraries, as the archive does,
does so by version 3 of the General Public License, with which the licences of all other parts agree.

")
file(STRINGS ${ROOT}/cmake/parts.txt parts ENCODING UTF-8 REGEX "^[^#]")
set(notices "")
foreach(part IN LISTS parts)
  string(REGEX MATCH "^([^|]+)\\|([^|]+)\\|([^|]+)\\|(.+)$" matched "${part}")
  set(name ${CMAKE_MATCH_1})
  set(package ${CMAKE_MATCH_2})
  string(APPEND text "  ${name}: ${CMAKE_MATCH_3}; ${CMAKE_MATCH_4}\n")
  set(file /usr/share/doc/${package}/copyright)
  if(package MATCHES "^npm:(.*)$")
    set(file ${ROOT}/node_modules/${CMAKE_MATCH_1}/LICENSE)
  endif()
  if(EXISTS ${file})
    file(READ ${file} notice)
    string(APPEND notices "\n======== ${name}\n\n${notice}")
  endif()
endforeach()
file(WRITE ${NOTICE} "${text}${notices}")
file(READ ${ROOT}/LICENSE own)
file(WRITE ${COPYRIGHT} "${own}\n${text}${notices}")
