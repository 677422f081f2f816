#!/bin/bash
# The golden frames (tests/golden) built and run in many ways must give the same bits:
# {g++, clang++} x {-O0, -O3} x {SSE2, AVX2, AVX-512 where the machine has it} x {1, 2, 7 threads}.
#   scripts/determinism.sh            all of it; about ten minutes on two cores
#   scripts/determinism.sh --quick    what CI runs beside its own builds: g++ -O0 and clang++ -O3 with the widest vectors
#   scripts/determinism.sh 'g++-13|-O2|-march=native' ...    combinations of your own: compiler, level, further flags
# Builds go to build/determinism/. The exit code is 1 when any combination gives other bits.
set -uo pipefail
cd "$(dirname "$0")/.."

widest=-mavx2
extensions=("" -mavx2)
if grep -qw avx512f /proc/cpuinfo; then
    widest="-mavx512f -mavx512vl -mavx512dq -mavx512bw"
    extensions+=("$widest")
fi

combinations=()
threads_of=(1 2 7)
if [ "${1:-}" = "--quick" ]; then
    threads_of=(7)
    combinations=("g++|-O0|" "clang++|-O3|$widest")
elif [ $# -gt 0 ]; then
    combinations=("$@")
else
    for compiler in g++ clang++; do
        for level in -O0 -O3; do
            for extension in "${extensions[@]}"; do combinations+=("$compiler|$level|$extension"); done
        done
    done
fi

worst=0
runs=0
for combination in "${combinations[@]}"; do
    IFS='|' read -r compiler level extension <<<"$combination"
    if ! command -v "$compiler" >/dev/null; then
        echo "determinism: SKIPPED $compiler: not installed"
        continue
    fi
    name=$(echo "${compiler##*/}$level$extension" | tr -c 'a-z0-9A-Z+\n' '_')
    folder=build/determinism/$name
    scripts/configure.sh release -B "$folder" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="$level $extension" \
        -DLRSM_BENCHMARKS=OFF >"build/$name.log" 2>&1 &&
        cmake --build "$folder" --target lrsm_golden >>"build/$name.log" 2>&1 || {
        tail -n 20 "build/$name.log"
        echo "determinism: $name does not build"
        worst=1
        continue
    }
    for threads in "${threads_of[@]}"; do
        if frames=$("$folder/tests/lrsm_golden" tests/golden/goldens.json $threads); then
            verdict="same bits"
        else
            verdict=DIFFERS
            worst=1
            echo "$frames"
        fi
        runs=$((runs + 1))
        printf 'determinism: %-8s %-4s %-10s %d threads   %s   %s\n' "$compiler" "$level" "${extension%% *}" $threads "$(echo "$frames" | tail -n 1)" "$verdict"
    done
done
echo "determinism: $runs runs compared"
exit $worst
