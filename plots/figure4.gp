# Figure 4: time of one step against the number of conjugate gradient iterations,
# and from how many iterations on each assembled storage is the cheaper. One plot
# of each arithmetic and number of threads; figure4: f64, one thread; figure4-lanes:
# many elements at a time.
# Reads bench.csv, fits.csv, crossings.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1200
height = 600
groups = group_list(4, "$4 \"@\" $8")
stem_of(a, t) = "figure4" . (a eq "f64" ? "" : many_lanes(a) && lanes == 1 ? "-lanes" : "-" . a) . \
  (t eq "1" ? "" : "-" . t . "threads")
lanes = 0 # arithmetics that have them
do for [g in groups] { lanes = lanes + (part(g, 2) eq "1" && many_lanes(part(g, 1))) }
model(v) = v[1:strstrt(v, "/") - 1]
rest(v) = v[strstrt(v, "/") + 1:*]
is(v) = strcol("figure") eq "4" && strcol("variant") eq v && strcol("threads") eq threads

# The fitted line of a variant: fixed + iteration n, s.
of_fit(v, n) = real(system(sprintf("awk -F, '$1 == \"%s\" && $3 == %s {print $%d}' %s", \
  v, threads, n, quoted("fits.csv"))))

do for [g in groups] {
  arithmetic = part(g, 1)
  threads = part(g, 2)
  variants = system("awk -F'[,/]' '$1 == 4 && $4 == \"" . arithmetic . "\" && $8 == " . threads . \
    " && !seen[$2 $3]++ {print $2 \"/\" $3 \"/\" $4}' " . quoted("bench.csv"))
  # "ebe" where all is one model, else the whole name.
  plain = words(system("echo '" . variants . "' | cut -d/ -f1 | uniq")) == 1
  chosen = "awk -F, 'NR == 1 || ($1 ~ /[/]" . arithmetic . "$/ && $4 == " . threads . ")' " . \
    quoted("crossings.csv")
  pairs = int(system(chosen . " | wc -l")) - 1
  eval sprintf("label(v) = %s", plain ? "rest(v)[1:strstrt(rest(v), '/') - 1]" : "v")
  array A[words(variants)]
  array B[words(variants)]
  do for [i = 1:words(variants)] {
    A[i] = of_fit(word(variants, i), 4)
    B[i] = of_fit(word(variants, i), 7)
  }
  do for [kind in "svg png"] {
    eval do_open(kind)
    set output in(stem_of(arithmetic, threads) . "." . kind)
    set multiplot title "Figure 4: does assembling pay? 3430 tetrahedra, 512 nodes, " . \
      (plain ? model(word(variants, 1)) . ", " : "") . arithmetic . ", " . in_threads(threads) \
      font ",15" noenhanced
    set label 1 footer at screen 0.01, 0.02 font ",8" textcolor "#606060" noenhanced

    set origin 0, 0.04; set size (pairs > 0 ? 0.56 : 1), 0.88
    set title "time of one step: medians, and the line through them" noenhanced
    set xlabel "conjugate gradient iterations in the step"
    set ylabel "time of one step, ms"
    set logscale xy
    set xrange [0.9:230]
    set yrange [*:*]
    set xtics (1, 2, 5, 10, 20, 50, 100, 200)
    set key top left noenhanced
    set arrow 1 from 50, graph 0 to 50, graph 1 nohead linestyle 20
    set label 2 "paper: 50" at 50, graph 0.04 right offset -0.6, 0 textcolor "#b00000"
    plot for [i = 1:words(variants)] 1e3 * (A[i] + B[i] * x) with lines linestyle i notitle, \
      for [i = 1:words(variants)] in("bench.csv") \
        using (is(word(variants, i)) ? column("iterations") : NaN):(1e3 * column("step_s_median")):\
              (1e3 * column("step_s_low")):(1e3 * column("step_s_high")) \
        with yerrorbars linestyle i dashtype 1 notitle, \
      for [i = 1:words(variants)] NaN with linespoints linestyle i title label(word(variants, i))

    unset label 1
    unset label 2
    unset arrow 1
    if (pairs > 0) {
      set origin 0.56, 0.04; set size 0.44, 0.88
      set title "assembled is cheaper from (95 % interval)"
      set xlabel "conjugate gradient iterations in the step"
      unset ylabel
      set xrange [0.4:300]
      unset logscale y
      set yrange [pairs + 0.7:0.3]
      set ytics scale 0 noenhanced
      set key bottom right
      shown(n) = n < 0.4 ? 0.4 : n
      top(n) = valid(7) ? shown(n) : 300
      set arrow 1 from 50, graph 0 to 50, graph 1 nohead linestyle 20
      set label 2 "paper: 50" at 50, graph 0.97 left offset 0.6, 0 textcolor "#b00000"
      plot "< " . chosen \
        using (shown(column("iterations"))):($0 + 1):(shown(column("iterations_low"))):(top(column("iterations_high"))):\
              ytic(label(strcol("assembled")) . " / " . label(strcol("unassembled"))) \
          with xerrorbars linestyle 1 notitle, \
        "" using (shown(column("iterations"))):($0 + 1):(sprintf("%.1f", column("iterations"))) \
          with labels offset 0, 0.9 notitle, \
        "" using (strcol("status") eq "never" ? 12 : NaN):($0 + 1):("never") with labels notitle
    }
    unset multiplot
    unset output
    unset arrow 1
    unset label 2
  }
}
