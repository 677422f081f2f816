# Flags that every target of ours is built with; who builds against an installed tree gets those that decide bits, since headers hold kernels
# too, and none of the others. Determinism: no contraction to fused multiply-add and no fast-math, so that
# g++ and clang++, -O0 and -O3, SSE2 and AVX-512 give the same bits.
add_library(lrsm_compiler INTERFACE)
target_compile_options(lrsm_compiler INTERFACE -ffp-contract=off -fno-fast-math)
target_compile_features(lrsm_compiler INTERFACE cxx_std_20)

set(ours -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
# g++ 12 and 13 see overlaps in std::string concatenation where there are none (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  list(APPEND ours -Wno-restrict)
endif()
# ccache can only remember units with a precompiled header when the preprocessed text still names it.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND ours -fpch-preprocess)
endif()
if(LRSM_WARNINGS_AS_ERRORS)
  list(APPEND ours -Werror)
endif()
target_compile_options(lrsm_compiler INTERFACE "$<BUILD_INTERFACE:${ours}>")

if(LRSM_SANITIZE)
  target_compile_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE})
endif()
# Headers are included by their path from the root, there as here.
target_include_directories(lrsm_compiler INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/lrsm>)
set_target_properties(lrsm_compiler PROPERTIES EXPORT_NAME compiler)
install(TARGETS lrsm_compiler EXPORT lrsmTargets)
