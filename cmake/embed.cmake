# Embeds files in a C++ source as raw strings: cmake -DOUT=... "-DFILES=name=path;..." -P embed.cmake
# With -DMAP=function -DHEADER=file, the source defines a function, declared in the header, that returns all files by
# name.
cmake_minimum_required(VERSION 3.25)
set(rows "")
foreach(entry IN LISTS FILES)
  string(REGEX MATCH "^([^=]+)=(.*)$" matched "${entry}")
  set(name "${CMAKE_MATCH_1}")
  if(NOT EXISTS "${CMAKE_MATCH_2}")
    message(FATAL_ERROR "${CMAKE_MATCH_2} is missing: run scripts/setup (or npm ci)")
  endif()
  file(READ "${CMAKE_MATCH_2}" content)
  string(APPEND rows "    {\"${name}\", R\"rigcal_asset(${content})rigcal_asset\"},\n")
endforeach()
if(MAP)
  file(WRITE "${OUT}" "#include \"${HEADER}\"

namespace rigcal::report {

const std::map<std::string_view, std::string_view>& ${MAP}() {
  static const std::map<std::string_view, std::string_view> kFiles{
${rows}  };
  return kFiles;
}

}  // namespace rigcal::report
")
  return()
endif()
file(WRITE "${OUT}" "#include \"report/document/assets.hpp\"

#include <map>

namespace rigcal::report {

std::string_view asset(std::string_view name) {
  static const std::map<std::string_view, std::string_view> kAssets{
${rows}  };
  return kAssets.at(name);
}

}  // namespace rigcal::report
")
