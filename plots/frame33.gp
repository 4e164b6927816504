# The largest mesh whose step fits into a frame of 33 ms.
# Reads frame33.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1200
variants = system("awk -F, 'NR > 1 && $6 > 0 && !seen[$1]++ {print $1}' " . quoted("frame33.csv"))
cases = system("awk -F, 'NR > 1 && $6 > 0 && !seen[$2 $3]++ {print $2 \"@\" $3}' " . \
  quoted("frame33.csv") . " | sort -t@ -k2n -k1")
rows = words(variants)
height = 200 + 70 * rows
is(v, c) = strcol("variant") eq v && strcol("mesh") eq part(c, 1) && strcol("threads") eq part(c, 2)
labels = ""
do for [i = 1:rows] { labels = labels . (i > 1 ? ", " : "") . sprintf("'%s' %d", word(variants, i), i) }
array POINT[8] = [7, 6, 5, 4, 9, 8, 13, 12]
array SHADE[8] = ["#000000", "#0072b2", "#000000", "#0072b2", "#000000", "#0072b2", "#000000", "#0072b2"]
at(i, c) = i + 0.16 * (c - (words(cases) + 1) / 2.0)

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("frame33." . kind)
  set title "The largest mesh whose step fits into 33 ms, 5 iterations (bar: to the next that does not)" \
    font ",13" noenhanced
  set label 1 footer at screen 0.01, 0.02 font ",8" textcolor "#606060" noenhanced
  set lmargin at screen 0.26; set rmargin at screen 0.79
  set bmargin at screen 90.0 / height; set tmargin at screen 1 - 50.0 / height
  set logscale x
  set xrange [3e4:6e6]
  set xtics ("30 000" 3e4, "100 000" 1e5, "300 000" 3e5, "1 million" 1e6, "3 million" 3e6)
  set yrange [rows + 0.6:0.4]
  eval "set ytics scale 0 noenhanced (" . labels . ")"
  set xlabel "tetrahedra"
  set key at screen 0.805, screen 0.8 top left
  plot for [c = 1:words(cases)] for [i = 1:rows] in("frame33.csv") \
      using (is(word(variants, i), word(cases, c)) ? column("tetrahedra") : NaN):(at(i, c)):\
            "tetrahedra":"exceeding_tetrahedra" \
      with xerrorbars pointtype POINT[c] linecolor rgb SHADE[c] linewidth 1.5 pointsize 1.2 notitle, \
    for [c = 1:words(cases)] NaN with points pointtype POINT[c] linecolor rgb SHADE[c] \
      pointsize 1.2 title part(word(cases, c), 1) . ", " . in_threads(part(word(cases, c), 2))
  unset output
}
