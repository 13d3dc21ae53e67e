# rigcal_library(name SOURCES ... LINKS ...): one layer as a static library, alias rigcal::name.
function(rigcal_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(rigcal_${name} STATIC ${ARG_SOURCES})
  add_library(rigcal::${name} ALIAS rigcal_${name})
  target_compile_features(rigcal_${name} PUBLIC cxx_std_20)
  target_include_directories(rigcal_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  target_link_libraries(rigcal_${name} PUBLIC ${ARG_LINKS}
    PRIVATE ${ARG_PRIVATE_LINKS} $<BUILD_INTERFACE:rigcal_warnings>)
endfunction()
