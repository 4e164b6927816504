# Roofline: one product of each variant under what the machine allows; a panel for
# each mesh and number of threads.
# Reads roofline.csv, machine.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1300
of(columns) = system("awk -F, '$1 == \"product\" && !seen[" . columns . "]++ {print " . columns . "}' " . \
  quoted("roofline.csv"))
panels = of("$3 \"@\" $5")
variants = of("$2")
threads_list = of("$5")
columns_of = words(threads_list)
rows_of = words(of("$3"))
height = 110 + 420 * rows_of
tets(mesh) = system("awk -F, '$3 == \"" . mesh . "\" {print $4; exit}' " . quoted("roofline.csv"))
storage(v) = system("echo " . v . " | cut -d/ -f2")
arithmetic(v) = system("echo " . v . " | cut -d/ -f3")
storages = system("echo '" . variants . "' | cut -d/ -f2 | awk '!seen[$0]++'")
arithmetics = system("echo '" . variants . "' | cut -d/ -f3 | awk '!seen[$0]++'")
nth(list, w) = int(system("echo '" . list . "' | grep -nx '" . w . "' | cut -d: -f1"))
is(v) = strcol("work") eq "product" && strcol("variant") eq v && strcol("mesh") eq mesh && \
  strcol("threads") eq threads

# The best of all instruction sets, and of read and triad; NaN: not measured.
best(pattern, t) = real(system("awk -F, '$1 ~ /^" . pattern . "$/ && $3 == " . t . \
  " && $4 > m {m = $4} END {print m ? m : \"NaN\"}' " . quoted("machine.csv")))
array V[4] = ["L1", "L2", "L3", "DRAM"]

# The shape says which storage, the filling which arithmetic: open, half, full.
array OPEN[5] = [6, 4, 8, 12, 10]
array FULL[5] = [7, 5, 9, 13, 11]
array ST[words(variants)]
array AR[words(variants)]
do for [i = 1:words(variants)] {
  ST[i] = nth(storages, storage(word(variants, i)))
  AR[i] = nth(arithmetics, arithmetic(word(variants, i)))
}
shape(s, a) = a == words(arithmetics) ? FULL[(s - 1) % 5 + 1] : OPEN[(s - 1) % 5 + 1]
shade(a) = a == 1 ? "#808080" : a == words(arithmetics) ? "#000000" : "#0072b2"
thickness(a) = a == 1 ? 1 : 2

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("roofline." . kind)
  set multiplot title "Roofline: how far is one product from what this machine allows?" \
    font ",15" noenhanced
  set samples 2000 # the roofs are cut off by it
  set logscale xy
  set xrange [0.1:40]
  set yrange [1:1000]
  set xtics (0.1, 0.2, 0.5, 1, 2, 5, 10, 20) nomirror
  do for [p = 1:words(panels)] {
    mesh = part(word(panels, p), 1)
    threads = part(word(panels, p), 2)
    c = nth(threads_list, threads) - 1
    r = nth(of("$3"), mesh) - 1
    set lmargin at screen 0.06 + c * 0.95 / columns_of
    set rmargin at screen 0.06 + (c + 1) * 0.95 / columns_of - 0.045
    set tmargin at screen 1 - (75.0 + r * 420) / height
    set bmargin at screen 1 - (75.0 + r * 420 + 345) / height
    set title sprintf("%s, %s tetrahedra, %s", mesh, tets(mesh), in_threads(threads)) noenhanced
    unset label
    set label 1 (p == 1 ? footer : "") at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced
    top32 = best("fma-f32", threads)
    top64 = best("fma-f64", threads)
    do for [l = 1:4] {
      slope = best("(read|triad)-" . V[l], threads)
      if (slope == slope) {
        set label 10 + l sprintf("%s %.0f GB/s", V[l], slope) \
          at 0.105, 0.105 * slope * (l < 3 ? 1.2 : 0.78) rotate by 28 font ",8" textcolor "#505050"
      }
    }
    set label 20 sprintf("f32 %.0f Gflop/s", top32) at 38, top32 * 1.15 right font ",9"
    set label 21 sprintf("f64 %.0f Gflop/s", top64) at 38, top64 * 1.15 right font ",9"
    if (p == 1) { set key bottom right noenhanced font ",9" maxrows 4 samplen 2 } else { unset key }
    if (r == rows_of - 1) { set xlabel "flops per byte, both counted" } else { unset xlabel }
    if (c == 0) { set ylabel "Gflop/s" } else { unset ylabel }
    B1 = best("(read|triad)-L1", threads); B2 = best("(read|triad)-L2", threads)
    B3 = best("(read|triad)-L3", threads); B4 = best("(read|triad)-DRAM", threads)
    roof(b, x) = b * x < top32 ? b * x : NaN
    plot roof(B1, x) with lines linecolor "#909090" dashtype 1 notitle, \
      roof(B2, x) with lines linecolor "#909090" dashtype 2 notitle, \
      roof(B3, x) with lines linecolor "#909090" dashtype 4 notitle, \
      roof(B4, x) with lines linecolor "#909090" dashtype 3 notitle, \
      (x > top32 / B1 ? top32 : NaN) with lines linecolor "#404040" linewidth 2 notitle, \
      (x > top64 / B1 ? top64 : NaN) with lines linecolor "#404040" linewidth 2 dashtype 2 notitle, \
      for [i = 1:words(variants)] in("roofline.csv") \
        using (is(word(variants, i)) ? column("flops_per_byte") : NaN):"gflops" with points \
        pointtype shape(ST[i], AR[i]) linecolor rgb shade(AR[i]) linewidth thickness(AR[i]) \
        pointsize 1.5 notitle, \
      for [s = 1:words(storages)] NaN with points pointtype FULL[(s - 1) % 5 + 1] \
        linecolor rgb "#000000" pointsize 1.5 title word(storages, s), \
      for [a = 1:words(arithmetics)] NaN with points pointtype shape(1, a) linecolor rgb shade(a) \
        linewidth thickness(a) pointsize 1.5 title word(arithmetics, a)
  }
  unset multiplot
  unset output
}
