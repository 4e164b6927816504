# How far the operator of each model is from the derivative of its force, against strain.
# Reads tangent.csv, truth-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "truth-footer.txt"
load "plots/style.gp"
width = 900
height = 600
models = system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("tangent.csv"))
rows(m) = "< awk -F, 'NR == 1 || $1 == \"" . m . "\"' " . quoted("tangent.csv")

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("tangent." . kind)
  set label 1 footer at screen 0.01, 0.015 font ",8" textcolor "#606060" noenhanced
  set title "How far the operator is from the derivative of the force" font ",14"
  set bmargin 5
  set grid
  set logscale xy
  set format xy "10^{%T}"
  set xlabel "strain"
  set ylabel "|K u + df| / |df|, the worst of 200 elements"
  set yrange [1e-12:1e3] # room for the key
  set key top left noenhanced
  plot for [i = 1:words(models)] rows(word(models, i)) using "strain":"error" with linespoints \
    linestyle i title word(models, i)
  unset output
}
