# Applies an example from docs/extending to the sources:
# cmake -DROOT=... -DEXAMPLE=... -DTREE=... -DGIT=... -P apply.cmake
# TREE then has the example's own files, and modified copies of the files (at most two) that its patch changes.
file(REMOVE_RECURSE ${TREE})
file(GLOB_RECURSE own RELATIVE ${EXAMPLE} ${EXAMPLE}/*.hpp ${EXAMPLE}/*.cpp ${EXAMPLE}/*.html)
foreach(file IN LISTS own)
  if(EXISTS ${ROOT}/${file})
    message(FATAL_ERROR "${EXAMPLE}/${file} would replace a file of the sources: say in change.patch what changes in it")
  endif()
  configure_file(${EXAMPLE}/${file} ${TREE}/${file} COPYONLY)
endforeach()
file(STRINGS ${EXAMPLE}/change.patch touched REGEX "^--- a/")
list(TRANSFORM touched REPLACE "^--- a/" "")
list(LENGTH touched places)
if(places GREATER 2)
  message(FATAL_ERROR "${EXAMPLE}/change.patch touches ${places} files; a thing is added in two places at most: ${touched}")
endif()
foreach(file IN LISTS touched)
  configure_file(${ROOT}/${file} ${TREE}/${file} COPYONLY)
endforeach()
# Git must not take TREE for part of an enclosing repository.
execute_process(COMMAND ${CMAKE_COMMAND} -E env GIT_CEILING_DIRECTORIES=${TREE}/.. ${GIT} apply -C1 ${EXAMPLE}/change.patch
  WORKING_DIRECTORY ${TREE} RESULT_VARIABLE failed ERROR_VARIABLE why)
if(failed)
  message(FATAL_ERROR "${EXAMPLE}/change.patch does not apply any more: ${why}")
endif()
file(TOUCH ${TREE}/applied)
