#!/bin/sh
# Formats all C++ by .clang-format, or with --check says what differs (exit code 1). Versions of clang-format differ in detail: 14 (Debian 12) decides.
#   scripts/format.sh [--check]
set -eu
cd "$(dirname "$0")/.."
formatter=$(command -v clang-format-14 || true)
if [ -z "$formatter" ]; then
    echo "format: SKIPPED: clang-format-14 is not installed"
    exit 0
fi
if [ "${1:-}" = "--check" ]; then
    git ls-files -z '*.h' '*.inc' '*.cpp' | xargs -0 "$formatter" --dry-run --Werror
else
    git ls-files -z '*.h' '*.inc' '*.cpp' | xargs -0 "$formatter" -i
fi
