cmake_minimum_required(VERSION 3.25)
# Installs, builds docs/examples/render against what was installed, and holds its hash against the installed program's.
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)
run(${SCRATCH} ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
expect_no_traces(${prefix})

# Each header finds the headers it includes.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include/lrsm ${prefix}/include/lrsm/*.h)
foreach(header IN LISTS headers)
  file(STRINGS ${prefix}/include/lrsm/${header} lines REGEX "^#include \"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"(.*)\".*" "\\1" included "${line}")
    if(NOT EXISTS ${prefix}/include/lrsm/${included})
      message(SEND_ERROR "${header} includes ${included}, which is not installed")
    endif()
  endforeach()
endforeach()

# The example is copied first: it may find nothing beside it.
file(COPY ${SOURCE}/docs/examples/render DESTINATION ${SCRATCH})
run(${SCRATCH} ${CMAKE_COMMAND} -G Ninja -S render -B render/build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER}
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
file(READ ${SCRATCH}/render/build/compile_commands.json commands)
if(NOT commands MATCHES "-ffp-contract=off" OR commands MATCHES "-Wshadow")
  message(SEND_ERROR "users get the flags that decide bits, and no others:\n${commands}")
endif()
run(${SCRATCH} ${CMAKE_COMMAND} --build render/build)

run(${SCRATCH} render/build/render_frame cornell-box)
message(STATUS "${output}")
set(example "${output}")
render_hash(${prefix}/bin/lrsm ${SCRATCH}/user cornell-box)
if(NOT example MATCHES "composite sha256 ${hash}\n")
  message(SEND_ERROR "the program says ${hash}, the example:\n${example}")
endif()
