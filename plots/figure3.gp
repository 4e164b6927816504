# Figure 3: a tetrahedron under forces without net torque. How far does it turn,
# and which torque do its own elastic forces have?
# Reads figure3.csv (model,time_s,angle_rad,torque), verify-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "verify-footer.txt"
load "plots/style.gp"
width = 1200
height = 560
models = system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("figure3.csv"))
is(i) = strcol("model") eq word(models, i)
rows = int(system("awk -F, 'NR == 2 {m = $1} $1 == m {n++} END {print n}' " . quoted("figure3.csv")))
# Points of different curves apart, so that curves that coincide are seen.
every_nth = rows > 40 ? rows / 10 : 1
floor_of(torque) = abs(torque) > 1e-18 ? abs(torque) : 1e-18

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("figure3." . kind)
  set multiplot title "Figure 3: who turns a tetrahedron that nobody turns?" font ",15" noenhanced
  set label 1 footer at screen 0.01, 0.02 font ",8" textcolor "#606060" noenhanced
  set xlabel "time, s"
  set xrange [*:*]
  set tmargin at screen 0.84; set bmargin at screen 0.17

  set lmargin at screen 0.07; set rmargin at screen 0.48
  set title "angle turned"
  set ylabel "degrees"
  set key top left noenhanced
  unset logscale
  set format y "%g"
  set yrange [*:*]
  plot for [i = 1:words(models)] in("figure3.csv") \
    using (is(i) ? column("time_s") : NaN):(column("angle_rad") * 180 / pi) \
    with linespoints linestyle i pointinterval every_nth + i title word(models, i)
  unset label 1

  set lmargin at screen 0.57; set rmargin at screen 0.98
  set title "ghost torque, relative"
  set ylabel "torque by force times distance"
  unset key
  set logscale y
  set format y "10^{%T}"
  set yrange [1e-19:*]
  unset mytics
  plot for [i = 1:words(models)] in("figure3.csv") \
    using (is(i) ? column("time_s") : NaN):(floor_of(column("torque"))) \
    with linespoints linestyle i pointinterval every_nth + i notitle
  unset multiplot
  unset output
}
