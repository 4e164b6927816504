# Error against time on a scene; refinement at equal time; ghost torque against the
# iterations of the frame and against lazy updates.
# Reads trade.csv, trade-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "trade-footer.txt"
load "plots/style.gp"
width = 1300
height = 1000
scene = system("awk -F, 'NR == 2 {print $1}' " . quoted("trade.csv"))
wide = system("awk -F, '$2 == \"step\" {print $5; exit}' " . quoted("trade.csv")) # widest float lanes
models = "linear node-warp qr-precomputed qr-updated qr-exact polar-closed-updated polar-exact svd-updated"
frames = "qr-updated qr-exact polar-closed-updated polar-higham-updated svd-updated"
# Rows that awk's condition selects, with a header of short names.
rows(condition) = "< awk -F, 'BEGIN {print \"iterations,tets,n,tolerance,lazy,ms,error,torque,energy\"} NR > 1 && " . \
  condition . " {print $7 \",\" $10 \",\" $11 \",\" $12 \",\" $13 \",\" 1e3 * $14 \",\" $15 \",\" $16 \",\" $17}' " . \
  quoted("trade.csv")
model(m) = rows("$2 == \"model\" && $3 == \"" . m . "\" && $5 == \"" . wide . "\"")
refined(m) = rows("$2 == \"refine\" && $3 == \"" . m . "\" && $7 == 10")
front = "< awk -F, 'BEGIN {print \"ms,error\"} NR > 1 && $2 != \"refine\" && $19 == 1 {print 1e3 * $14 \",\" $15}' " . \
  quoted("trade.csv") . " | sort -t, -g"
tuned(m, by) = rows("$2 == \"frame\" && $3 == \"" . m . "\" && $12 " . (by eq "n" ? "== 0" : "> 0"))
lazy(m, storage) = rows("$2 == \"lazy\" && $3 == \"" . m . "\" && $4 == \"" . storage . "\"")

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("trade." . kind)
  set multiplot layout 2, 2 margins 0.07, 0.985, 0.085, 0.92 spacing 0.085, 0.155 \
    title "Speed for accuracy: scene " . scene font ",15" noenhanced
  set label 1 footer at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced
  set grid
  set logscale xy
  set format xy "10^{%T}"
  set key font ",9" noenhanced
  set title "Models, 1 to 100 iterations, the scene's step, " . wide noenhanced
  set xlabel "ms of computing for a simulated second" # of both upper ones
  set xtics 10
  set xrange [*:3e4] noextend
  set yrange [1e-4:1] # room for the key
  set ylabel "largest error of a displacement, of the size"
  set key inside bottom left
  set format x "%g"
  plot for [i = 1:words(models)] model(word(models, i)) using "ms":"error" with linespoints \
      linestyle i title word(models, i), \
    front using "ms":"error" with steps linewidth 6 linecolor rgb "#c0c0c0" title "front of all settings"
  unset label 1
  set xrange [*:3e3] noextend
  set yrange [*:*]
  set title "More refined meshes at equal time: 10 iterations"
  plot for [i = 1:words(frames)] refined(word(frames, i)) using "ms":"error" with linespoints \
      linestyle i title word(frames, i)
  set title "Ghost torque against the work of the frame (rest B)"
  set xtics 1
  set xlabel "iterations of the frame in a step"
  set ylabel "largest relative torque"
  unset logscale x
  set xrange [0.5:10.5]
  set yrange [1e-23:1] # room for the key
  set key inside bottom right
  set xtics nomirror
  set x2label "tolerance of the frame (open symbols)" offset 0, -0.9
  set logscale x2
  set x2range [0.3:3e-11]
  set x2tics ("0.1" 0.1, "10^{-3}" 1e-3, "10^{-5}" 1e-5, "10^{-7}" 1e-7, "10^{-9}" 1e-9) offset 0, -0.5
  plot tuned("polar-higham-tuned", "n") using "n":"torque" with linespoints linestyle 1 \
      title "Newton-Higham, iterations", \
    tuned("polar-higham-tuned", "tol") using "tolerance":"torque" axes x2y1 with linespoints \
      linestyle 8 title "Newton-Higham, tolerance", \
    tuned("polar-quaternion-tuned", "n") using "n":"torque" with linespoints linestyle 3 \
      title "warm-started quaternion, turns", \
    tuned("polar-quaternion-tuned", "tol") using "tolerance":"torque" axes x2y1 with linespoints \
      linestyle 10 title "warm-started quaternion, tolerance"
  unset x2tics; unset x2label; unset logscale x2
  set title "Lazy update of B: what a tolerance costs"
  set xlabel "B is kept while the stretch has moved by less"
  set ylabel "relative torque; error; time of tolerance 0 = 1"
  set logscale x
  set format x "10^{%T}"
  set xtics 10
  set xrange [5e-6:2]
  set yrange [1e-9:3]
  t0(m, s) = real(system("awk -F, '$2 == \"lazy\" && $3 == \"" . m . "\" && $4 == \"" . s . \
    "\" && $13 == 0 {print 1e3 * $14; exit}' " . quoted("trade.csv")))
  qr0 = t0("qr-lazy", "ebe-paper"); polar0 = t0("polar-closed-lazy", "ebe-paper")
  set key inside bottom right
  plot lazy("qr-lazy", "ebe") using "lazy":"torque" with linespoints linestyle 3 title "qr: torque", \
    lazy("qr-lazy", "ebe") using "lazy":"error" with linespoints linestyle 10 title "... error", \
    lazy("qr-lazy", "ebe-paper") using "lazy":(column("ms") / qr0) with linespoints linestyle 4 \
      title "... time, ebe-paper", \
    lazy("polar-closed-lazy", "ebe") using "lazy":"torque" with linespoints linestyle 1 title "polar: torque", \
    lazy("polar-closed-lazy", "ebe") using "lazy":"error" with linespoints linestyle 8 title "... error", \
    lazy("polar-closed-lazy", "ebe-paper") using "lazy":(column("ms") / polar0) with linespoints linestyle 6 \
      title "... time, ebe-paper"
  unset multiplot
  unset output
  unset logscale; set autoscale; unset title; unset xlabel; unset ylabel
}
