# Figure 7: time of one step against the number of tetrahedra, for each element
# frame, and its ratio to that of QR. One plot of each storage, arithmetic and number
# of threads; figure7: as in the paper; figure7-ebe: a product without frames;
# figure7-lanes: many elements at a time, in clusters.
# Reads bench.csv, ratios.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1200
height = 860
iterations = 5
groups = group_list(7, "$3 \"@\" $4 \"@\" $8")
stem_of(s, a, t) = "figure7" . (many_lanes(a) ? "-lanes" . (s eq "ebe-cluster" ? "" : "-" . s) : \
  s eq "ebe-paper" ? "" : "-" . s) . (t eq "1" ? "" : "-" . t . "threads")
first = "awk -F'[,/]' '$1 == 7 && !seen[$2]++ {print $2}' " . quoted("bench.csv")
of_group(g) = "awk -F'[,/]' '$1 == 7 && $3 \"@\" $4 \"@\" $8 == \"" . g . "\" && !seen[$2]++ {print $2}' " . \
  quoted("bench.csv")
# Models whose name ends so, and all frames, in the order of the file.
models(g, policy) = system(of_group(g) . " | grep -E -- '-(" . policy . ")$'")
frames = system(first . " | grep -E -- '-(updated|precomputed|exact)$' | " . \
  "sed -E 's/-(updated|precomputed)$//' | awk '!seen[$0]++'")
frame(m) = system("echo " . m . " | sed -E 's/-(updated|precomputed)$//'")
style_of(m) = int(system("echo '" . frames . "' | grep -nx '" . frame(m) . "' | cut -d: -f1"))
# Times of "qr-updated" are what those of "polar-higham-updated" are divided by.
policy(m) = system("echo " . m . " | sed 's/.*-//'")

whole(m) = m . "/" . storage . "/" . arithmetic
is(m) = strcol("figure") eq "7" && column("iterations") == iterations && \
  strcol("variant") eq whole(m) && strcol("threads") eq threads
is_ratio(m, base) = strcol("figure") eq "7" && column("iterations") == iterations && \
  strcol("numerator") eq whole(m) && strcol("denominator") eq whole(base) && \
  strcol("threads") eq threads
# Side by side, so that intervals do not hide each other.
aside(i) = column("tetrahedra") * 1.04 ** (i - 3)


do for [g in groups] {
  storage = part(g, 1)
  arithmetic = part(g, 2)
  threads = part(g, 3)
  # The same axis for all panels of an arithmetic, with room for the key.
  times = "awk -F'[,/]' '$1 == 7 && $4 == \"" . arithmetic . "\" && $9 > 0 {print 1e3 * $9}' " . \
    quoted("bench.csv")
  fastest = real(system(times . " | sort -g | head -n 1"))
  slowest = real(system(times . " | sort -g | tail -n 1"))
  stem = stem_of(storage, arithmetic, threads)
  do for [kind in "svg png"] {
    eval do_open(kind)
    set output in(stem . "." . kind)
    set multiplot title sprintf("Figure 7: what does the frame cost? %s, %s, %s, %d iterations", \
      storage eq "ebe-paper" ? "R, B, D stored apart (ebe-paper)" : \
      storage eq "ebe" ? "frame-free product (ebe)" : storage, arithmetic, in_threads(threads), \
      iterations) font ",15" noenhanced
    set label 1 footer at screen 0.01, 0.015 font ",8" textcolor "#606060" noenhanced
    set logscale x
    set xrange [380:150000]
    set xtics ("500" 500, "3430" 3430, "10 000" 10000, "33 750" 33750, "106 480" 106480)
    do for [side = 1:2] {
      list = models(g, side == 1 ? "updated" : "precomputed|exact")
      if (words(list) == 0) { continue }
      array S[words(list)]
      array Q[words(list)]
      do for [i = 1:words(list)] {
        S[i] = style_of(word(list, i))
        Q[i] = "qr-" . policy(word(list, i))
      }
      set lmargin at screen (side == 1 ? 0.07 : 0.565)
      set rmargin at screen (side == 1 ? 0.485 : 0.98)

      set tmargin at screen 0.90; set bmargin at screen 0.46
      set title side == 1 ? "B updated at every step" : "B precomputed, and the exact gradient"
      set ylabel "time of one step, ms"
      unset xlabel
      set logscale y
      set yrange [0.7 * fastest:6 * slowest]
      set key top left noenhanced
      plot for [i = 1:words(list)] in("bench.csv") \
        using (is(word(list, i)) ? column("tetrahedra") : NaN):(1e3 * column("step_s_median")) \
        with linespoints linestyle S[i] title word(list, i)
      unset label 1

      set tmargin at screen 0.37; set bmargin at screen 0.10
      set title "ratio to QR with the same B (95 % interval)"
      set ylabel "time by that of QR"
      set xlabel "tetrahedra"
      unset logscale y
      set yrange [0.5:*]
      set key bottom right
      plot for [i = 1:words(list)] in("ratios.csv") \
          using (is_ratio(word(list, i), Q[i]) ? aside(S[i]) : NaN):"ratio_median" \
          with lines linestyle S[i] notitle, \
        for [i = 1:words(list)] in("ratios.csv") \
          using (is_ratio(word(list, i), Q[i]) ? aside(S[i]) : NaN):\
                "ratio_median":"ratio_low":"ratio_high" \
          with yerrorbars linestyle S[i] dashtype 1 notitle, \
        side == 1 ? 1.3 : NaN with lines linestyle 20 \
          title side == 1 ? "paper, polar by QR: 1.3" : ""
    }
    unset multiplot
    unset output
  }
}
