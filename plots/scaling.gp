# Time of a step against the size of the mesh, threads and iterations.
# Reads scaling.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1300
height = 900
variants = system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("scaling.csv"))
threads = system("awk -F, 'NR > 1 && !seen[$4]++ {print $4}' " . quoted("scaling.csv") . " | sort -n")
few = word(threads, 1)
many = word(threads, words(threads))
is(v, t) = strcol("variant") eq v && strcol("threads") eq t
at_five(v, t) = is(v, t) && column("iterations") == 5
times = "awk -F, 'NR > 1 && $3 == 5 && $8 > 0 {print $8}' " . quoted("scaling.csv") . " | sort -g | "
low = real(system(times . "head -n 1"))
high = real(system(times . "tail -n 1"))

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("scaling." . kind)
  set multiplot title "Scaling: one step against tetrahedra, threads and iterations; grid" \
    font ",15" noenhanced
  set label 1 footer at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced

  set tmargin at screen 0.90; set bmargin at screen 0.56
  set xlabel "tetrahedra"
  set ylabel "ns per tetrahedron and step"
  set logscale xy
  set xrange [400:2.6e6]
  set xtics ("500" 500, "3430" 3430, "10^4" 1e4, "10^5" 1e5, "10^6" 1e6)
  set ytics (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
  set yrange [0.7 * low:1.5 * high]
  do for [side = 1:2] {
    t = side == 1 ? few : many
    set lmargin at screen (side == 1 ? 0.06 : 0.56)
    set rmargin at screen (side == 1 ? 0.48 : 0.98)
    set title "5 iterations, " . in_threads(t)
    unset key
    plot for [i = 1:words(variants)] in("scaling.csv") \
      using (at_five(word(variants, i), t) ? column("tetrahedra") : NaN):"ns_per_tetrahedron" \
      with linespoints linestyle i notitle
    unset label 1
  }

  set tmargin at screen 0.44; set bmargin at screen 0.10
  set lmargin at screen 0.06; set rmargin at screen 0.48
  set title "times faster than on one thread (95 % interval), " . in_threads(many)
  set ylabel "time on one thread by time on all"
  unset logscale y
  set ytics autofreq
  set yrange [0:1.3 * many]
  unset key
  set arrow 1 from 400, real(many) to 2.6e6, real(many) nohead linestyle 20
  aside(i) = column("tetrahedra") * 1.05 ** (i - 3)
  plot for [i = 1:words(variants)] in("scaling.csv") \
      using (at_five(word(variants, i), many) ? aside(i) : NaN):"speedup" \
      with lines linestyle i notitle, \
    for [i = 1:words(variants)] in("scaling.csv") \
      using (at_five(word(variants, i), many) ? aside(i) : NaN):"speedup":"speedup_low":"speedup_high" \
      with yerrorbars linestyle i dashtype 1 notitle
  unset arrow 1

  set lmargin at screen 0.56; set rmargin at screen 0.98
  set title "3430 tetrahedra, " . in_threads(few)
  set xlabel "conjugate gradient iterations"
  set ylabel "time of one step, ms"
  set logscale y
  set yrange [*:*]
  set key top left noenhanced
  set xrange [0.9:60]
  set xtics (1, 2, 5, 10, 20, 50)
  set ytics (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50)
  plot for [i = 1:words(variants)] in("scaling.csv") \
    using (is(word(variants, i), few) && column("tetrahedra") == 3430 ? column("iterations") : NaN):\
          (1e3 * column("step_s_median")) \
    with linespoints linestyle i title word(variants, i)
  unset multiplot
  unset output
}
