# Flags that every target of ours is built with. Determinism: no contraction to fused multiply-add and no fast-math, so that
# g++ and clang++, -O0 and -O3, SSE2 and AVX-512 give the same bits.
add_library(lrsm_compiler INTERFACE)
target_compile_options(lrsm_compiler INTERFACE -ffp-contract=off -fno-fast-math)
target_compile_options(lrsm_compiler INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor)
if(LRSM_WARNINGS_AS_ERRORS)
  target_compile_options(lrsm_compiler INTERFACE -Werror)
endif()
if(LRSM_SANITIZE)
  target_compile_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(lrsm_compiler INTERFACE -fsanitize=${LRSM_SANITIZE})
endif()
target_include_directories(lrsm_compiler INTERFACE ${PROJECT_SOURCE_DIR})
