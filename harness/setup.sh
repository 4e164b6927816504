#!/bin/sh
# setup.sh - install what the build needs and this system lacks (Debian).
# usage: CC=gcc INCLUDES='-I...' setup.sh [COMMAND...]; a COMMAND is needed too
#        and comes from the package of its name.
# A library counts as there when a program that uses its header compiles and
# links, wherever it came from; what is missing comes by apt-get, if there is one.
#
# SPDX-License-Identifier: BSD-3-Clause
set -u
CC=${CC:-gcc}
INCLUDES=${INCLUDES:-}
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT

stop() {
  echo "setup: $1" >&2
  exit 1
}

has_library() { # HEADER LIBRARIES
  printf '#include <%s>\n' stdarg.h stddef.h stdint.h setjmp.h "$1" >"$scratch/try.c"
  echo 'int main(void) { return 0; }' >>"$scratch/try.c"
  # shellcheck disable=SC2086
  $CC $INCLUDES -o "$scratch/try" "$scratch/try.c" $2 2>/dev/null
}

has_openmp() { # COMPILER
  printf '#include <omp.h>\nint main(void) { return omp_get_max_threads() < 1; }\n' \
    >"$scratch/try.c"
  $1 -fopenmp -o "$scratch/try" "$scratch/try.c" 2>/dev/null
}

has_fuzzer() { # COMPILER
  echo 'int LLVMFuzzerTestOneInput(const char *data, unsigned long size);
    int LLVMFuzzerTestOneInput(const char *data, unsigned long size) { return data && size > 9; }' \
    >"$scratch/try.c"
  $1 -fsanitize=fuzzer,address -o "$scratch/try" "$scratch/try.c" 2>/dev/null
}

lack() { # PACKAGE WHY
  packages="$packages $1"
  reasons="$reasons  $1: $2
"
}

look() { # COMMAND...
  packages='' reasons=''
  command -v "${CC%% *}" >/dev/null || lack "${CC%% *} libc6-dev" 'compiles everything'
  has_library cholmod.h -lcholmod || lack libsuitesparse-dev \
    'CHOLMOD, the direct solver that the kernels are held against'
  has_library gsl/gsl_rng.h '-lgsl -lgslcblas -lm' || lack libgsl-dev \
    'the GNU Scientific Library: statistics, random numbers, SVD and QR to compare with'
  has_library jansson.h -ljansson || lack libjansson-dev 'Jansson, writes the results as JSON'
  has_library cmocka.h -lcmocka || lack libcmocka-dev 'cmocka, runs the tests'
  command -v gnuplot >/dev/null || lack gnuplot-nox 'gnuplot, draws the figures'
  for command in "$@"; do
    command -v "$command" >/dev/null || lack "$command" 'asked for by who called setup'
  done
  for compiler in "$CC" "$@"; do # gcc brings its own
    case $compiler in
    *clang*)
      has_openmp "$compiler" || lack libomp-dev 'OpenMP for clang, runs the threads'
      has_fuzzer "$compiler" || lack libclang-rt-dev 'sanitizers for clang and libFuzzer, for make fuzz'
      ;;
    esac
  done
}

look "$@"
if [ -z "$packages" ]; then
  echo 'setup: nothing to install'
  exit 0
fi
printf 'setup: missing here (names as Debian packages):\n%s' "$reasons"

command -v apt-get >/dev/null || stop "there is no apt-get on this system: install the above by \
its own package manager or from source, where $CC finds them, then run this again"
if [ "$(id -u)" = 0 ]; then
  as_root=env
else
  command -v sudo >/dev/null || stop "installing needs root and there is no sudo: run, as root, \
apt-get install$packages"
  as_root='sudo env'
  echo 'setup: not root, so apt-get runs through sudo, which may ask for your password'
fi

apt() {
  echo "setup: apt-get $*"
  $as_root DEBIAN_FRONTEND=noninteractive apt-get -q "$@" </dev/null ||
    stop "apt-get $* failed; its own words are above"
}
apt update
# shellcheck disable=SC2086
apt install -y --no-install-recommends $packages

look "$@"
[ -z "$packages" ] || stop "installed, but $CC still does not find:$packages"
echo 'setup: done'
