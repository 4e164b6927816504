#!/bin/sh
# draw.sh DIR - draw every figure whose data are in DIR, and measure nothing.
# Run from the root of the project.
# SPDX-License-Identifier: BSD-3-Clause
set -u
dir=$1

if ! command -v gnuplot >/dev/null; then
  echo "plots: gnuplot is not installed; 'make setup' installs it" >&2
  exit 2
fi
if [ ! -f "$dir/bench.csv" ] && [ ! -f "$dir/figure3.csv" ] &&
  [ ! -f "$dir/trade.csv" ] && [ ! -f "$dir/tangent.csv" ] && [ ! -f "$dir/recovery.csv" ] &&
  [ ! -f "$dir/extremes-map.csv" ] && ! ls "$dir"/*-film.csv >/dev/null 2>&1; then
  echo "plots: there are no results in $dir; 'make bench' measures some" >&2
  exit 2
fi

# Is there a line in DIR/$1 that matches $2?
has() { grep -qsE "$2" "$dir/$1"; }

status=0
draw() {
  echo "drawing $1"
  gnuplot -e "results='$dir'; film='${2-}'" "plots/$1.gp" 2>"$dir/gnuplot.log" || status=2
  # a filter that left out all; what the animation says of itself
  grep -v -e 'no valid points' -e 'frames in animation sequence' "$dir/gnuplot.log" >&2
  rm -f "$dir/gnuplot.log"
}

# Figures of an earlier run must not stand beside the data of this one.
for kind in svg png; do
  rm -f "$dir"/figure*."$kind"
  for name in convergence speed roofline scaling frame33 trade tangent \
    extremes extremes-paths recovery recovery-time; do rm -f "$dir/$name.$kind"; done
done
has figure3.csv '^[^,]+,[0-9]' && draw figure3
has fits.csv '^[^,]+,[0-9]' && draw figure4
has bench.csv '^7,.*,[0-9.e+-]+,(ok|unstable),' && draw figure7
has convergence.csv '^[^,]+,[0-9]' && draw convergence
has speed.csv '^[^,]+,.*,[0-9.e+-]+,[01]$' && draw speed
has roofline.csv '^product,' && draw roofline
has scaling.csv '^[^,]+,[0-9]' && draw scaling
has frame33.csv '^([^,]+,){5}[0-9]' && draw frame33
has tangent.csv '^[^,]+,[0-9]' && draw tangent
has extremes-map.csv '^[^,]+,[^,]+,[^,]+,f[0-9]' && draw extremes
has extremes-paths.csv '^[^,]+,[0-9]' && draw extremes-paths
has recovery.csv '^[^,]+,[^,]+,[0-9]' && draw recovery && draw recovery-time
has trade.csv '^[^,]+,(model|storage),' && draw trade
for film in "$dir"/*-film.csv; do
  [ -f "$film" ] || continue
  name=$(basename "$film" -film.csv)
  rm -f "$dir/$name.png" "$dir/$name.gif"
  if [ -f "$dir/$name-faces.txt" ]; then draw film "$name"; fi
done
find "$dir" -maxdepth 1 \( -name "*.gif" -o -name "*.svg" -o -name "*.png" \) | sort
exit $status
