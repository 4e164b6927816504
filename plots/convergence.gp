# Error of the conjugate gradient against the direct solution of the same step,
# after each number of iterations.
# Reads convergence.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1000
height = 600
curves = system("awk -F, 'NR > 1 && !seen[$1 $3]++ {print $1 \"@\" $3}' " . quoted("convergence.csv"))
variant(c) = c[1:strstrt(c, "@") - 1]
variants = words(system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("convergence.csv")))
step(c) = real(c[strstrt(c, "@") + 1:*])
is(c) = strcol("variant") eq variant(c) && abs(column("h_s") / step(c) - 1) < 1e-9

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("convergence." . kind)
  set title "How far is one step from its direct solution? 3430 tetrahedra" . \
    (variants == 1 ? ", " . variant(word(curves, 1)) : "") font ",14" offset 0, 0.5 noenhanced
  set label 1 footer at screen 0.01, 0.02 font ",8" textcolor "#606060" noenhanced
  set bmargin at screen 0.14
  set rmargin at screen 0.97
  set xlabel "conjugate gradient iterations"
  set ylabel "relative error of the velocity change"
  set logscale xy
  set format y "10^{%T}"
  set xrange [0.9:220]
  set yrange [1e-16:3]
  unset mytics
  set xtics (1, 2, 5, 10, 20, 50, 100, 200)
  set key bottom left noenhanced
  set arrow 1 from 5, graph 0 to 5, graph 1 nohead linestyle 20
  set label 2 "paper: 5" at 5, 1e-9 right offset -0.6, 0 textcolor "#b00000"
  plot for [i = 1:words(curves)] in("convergence.csv") \
    using (is(word(curves, i)) ? column("iterations") : NaN):"error" with linespoints linestyle i \
    title (variants == 1 ? "" : variant(word(curves, i)) . ", ") . \
      sprintf("h = %g ms", 1e3 * step(word(curves, i)))
  unset output
}
