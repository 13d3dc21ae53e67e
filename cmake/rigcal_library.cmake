# If several objects define the same inline function, the linker keeps the first. The objects of numerical code come
# first, so that they do not use a less optimised function from a test or page writer.
#   rigcal_optimised_first(target layer...)
function(rigcal_optimised_first target)
  foreach(layer IN LISTS ARGN)
    get_property(objects GLOBAL PROPERTY RIGCAL_OPTIMISED_${layer})
    target_sources(${target} PRIVATE ${objects})
  endforeach()
endfunction()

# Numerical code is optimised under the sanitizers, too, because the tests would otherwise be far too slow. Code that
# prepares, judges or writes is not optimised, so that it compiles in a third of the time. Even a release optimises it
# less.
set(rigcal_optimised $<$<OR:$<BOOL:${RIGCAL_SANITIZE}>,$<BOOL:${RIGCAL_SANITIZE_THREAD}>>:-O1>)
set(rigcal_less_optimised $<$<CONFIG:Release>:-O1>)
set(rigcal_light report)

# In the layers that read files, libFuzzer tracks which code an input reaches.
set(rigcal_fuzzed common datasets report)

# Objects of these targets may be linked into the command and into a shared module (CMakeLists.txt).
function(rigcal_position_independent)
  set_target_properties(${ARGN} PROPERTIES POSITION_INDEPENDENT_CODE ${rigcal_shared})
  if(rigcal_shared)
    set_target_properties(${ARGN} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  endif()
endfunction()

# rigcal_library(name SOURCES ... LIGHT ... LINKS ...) adds one layer as a static library with the alias rigcal::name.
# LIGHT lists the sources that need little computing time, unlike the others in their layer.
function(rigcal_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIGHT;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(rigcal_${name} STATIC ${ARG_SOURCES})
  add_library(rigcal::${name} ALIAS rigcal_${name})
  set(parts rigcal_${name})
  if(ARG_LIGHT)
    add_library(rigcal_${name}_light OBJECT ${ARG_LIGHT})
    target_sources(rigcal_${name} PRIVATE $<TARGET_OBJECTS:rigcal_${name}_light>)
    list(APPEND parts rigcal_${name}_light)
  endif()
  foreach(part IN LISTS parts)
    target_compile_features(${part} PUBLIC cxx_std_20)
    target_include_directories(${part} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    if(name IN_LIST rigcal_light OR part MATCHES "_light$")
      target_compile_options(${part} PRIVATE ${rigcal_less_optimised})
    else()
      target_compile_options(${part} PRIVATE ${rigcal_optimised})
      set_property(GLOBAL APPEND PROPERTY RIGCAL_OPTIMISED_${name} $<TARGET_OBJECTS:${part}>)
    endif()
    # A wrong index ends the program, as under the sanitizers, instead of giving a wrong estimate. The solver, which is
    # not built by this function, goes without.
    target_compile_definitions(${part} PRIVATE $<$<CONFIG:Release>:_GLIBCXX_ASSERTIONS>)
    if(RIGCAL_FUZZ AND name IN_LIST rigcal_fuzzed)
      target_compile_options(${part} PRIVATE -fsanitize=fuzzer-no-link)
    endif()
    target_link_libraries(${part} PUBLIC ${ARG_LINKS}
      PRIVATE ${ARG_PRIVATE_LINKS} $<BUILD_INTERFACE:rigcal_warnings>)
  endforeach()
  rigcal_position_independent(${parts})
  set_target_properties(rigcal_${name} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS rigcal_${name} EXPORT rigcal COMPONENT development ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endfunction()
