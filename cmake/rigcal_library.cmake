# What computes is optimised under the sanitizers too, or the tests would crawl. Everything else
# is not, and less than that in a release: it compiles in half the time so.
set(rigcal_optimised $<$<BOOL:${RIGCAL_SANITIZE}>:-O1>)
set(rigcal_less_optimised $<$<CONFIG:Release>:-O1>)
set(rigcal_computing common model metrics datasets calib diagnosis)

# rigcal_library(name SOURCES ... LINKS ...): one layer as a static library, alias rigcal::name.
function(rigcal_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(rigcal_${name} STATIC ${ARG_SOURCES})
  add_library(rigcal::${name} ALIAS rigcal_${name})
  target_compile_features(rigcal_${name} PUBLIC cxx_std_20)
  target_include_directories(rigcal_${name} PUBLIC ${PROJECT_SOURCE_DIR})
  if(name IN_LIST rigcal_computing)
    target_compile_options(rigcal_${name} PRIVATE ${rigcal_optimised})
  else()
    target_compile_options(rigcal_${name} PRIVATE ${rigcal_less_optimised})
  endif()
  target_link_libraries(rigcal_${name} PUBLIC ${ARG_LINKS}
    PRIVATE ${ARG_PRIVATE_LINKS} $<BUILD_INTERFACE:rigcal_warnings>)
endfunction()
