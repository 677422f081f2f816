# Flags that every target of ours is built with. Determinism: no contraction to fused multiply-add and no fast-math, so that
# g++ and clang++, -O0 and -O3, SSE2 and AVX-512 give the same bits.
add_library(lrsm_compiler INTERFACE)
target_compile_options(lrsm_compiler INTERFACE -ffp-contract=off -fno-fast-math)
target_compile_options(lrsm_compiler INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
# g++ 12 and 13 see overlaps in std::string concatenation where there are none (GCC bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 14)
  target_compile_options(lrsm_compiler INTERFACE -Wno-restrict)
endif()
# ccache can only remember units with a precompiled header when the preprocessed text still names it.
target_compile_options(lrsm_compiler INTERFACE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
if(LRSM_WARNINGS_AS_ERRORS)
  target_compile_options(lrsm_compiler INTERFACE -Werror)
endif()
if(LRSM_SANITIZE)
  target_compile_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE})
endif()
target_include_directories(lrsm_compiler INTERFACE ${PROJECT_SOURCE_DIR})
