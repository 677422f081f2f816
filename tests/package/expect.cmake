# What both tests of this folder need.

# Runs a command as from a user's folder; its output comes in `output`, and a failure ends the test.
macro(run folder)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${folder} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "exit code ${result}: ${ARGN}\n${output}")
  endif()
endmacro()

# No file below the folder may name a folder of this machine: the source's or the build's.
function(expect_no_traces folder)
  file(GLOB_RECURSE files ${folder}/*)
  foreach(trace ${BUILD} ${SOURCE})
    execute_process(COMMAND grep --recursive --files-with-matches --fixed-strings "${trace}" ${folder} OUTPUT_VARIABLE found)
    if(found)
      message(SEND_ERROR "these name ${trace}:\n${found}")
    endif()
  endforeach()
  list(LENGTH files count)
  message(STATUS "${count} files name neither ${BUILD} nor ${SOURCE}")
endfunction()

# The composite's hash of a frame that the program at `program` renders in `folder`, in `hash`.
macro(render_hash program folder scene)
  run(${folder} ${program} render ${scene} --size 160x90 --quiet -o frame)
  file(READ ${folder}/frame/frame.json json)
  string(JSON passes LENGTH "${json}" passes)
  math(EXPR last "${passes} - 1")
  string(JSON name GET "${json}" passes ${last} name)
  string(JSON hash GET "${json}" passes ${last} sha256)
  if(NOT name STREQUAL "composite")
    message(SEND_ERROR "the last pass is ${name}, not the composite")
  endif()
endmacro()
