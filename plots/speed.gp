# How many times faster than the paper's method in scalar f64 on one thread, and the
# error of each arithmetic beside it.
# Reads speed.csv, footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
width = 1300
meshes = system("awk -F, 'NR > 1 && !seen[$2]++ {print $2}' " . quoted("speed.csv"))
variants = system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("speed.csv"))
threads = system("awk -F, 'NR > 1 && !seen[$4]++ {print $4}' " . quoted("speed.csv") . " | sort -n")
tets(mesh) = system("awk -F, '$2 == \"" . mesh . "\" {print $3; exit}' " . quoted("speed.csv"))
base = "qr-updated/ebe-paper/f64"
rows = words(variants)
height = 210 + 21 * rows
row(v) = int(system("echo '" . variants . "' | grep -nx '" . v . "' | cut -d: -f1"))
# The row of each variant, once: strings in a filter are slow to look up in the shell.
file(mesh, t) = "< awk -F, 'BEGIN {n = split(\"" . variants_line . "\", v, \" \"); for (i = 1; i <= n; i++) row[v[i]] = i; " . \
  "print \"row,faster,low,high,force,position\"} $2 == \"" . mesh . "\" && $4 == \"" . t . \
  "\" {print row[$1] \",\" $8 \",\" $9 \",\" $10 \",\" $12 \",\" $13}' " . quoted("speed.csv")
variants_line = system("echo '" . variants . "' | tr '\\n' ' '")
point(i) = i == 1 ? 7 : i == 2 ? 4 : 8 + i
shade(i) = i == 1 ? "#000000" : i == 2 ? "#0072b2" : "#707070"
panels = words(meshes) + 1
left(p) = 0.25 + (p - 1) * 0.745 / panels
labels = ""
blanks = ""
do for [i = 1:rows] {
  labels = labels . (i > 1 ? ", " : "") . sprintf("'%s' %d", word(variants, i), i)
  blanks = blanks . (i > 1 ? ", " : "") . sprintf("'' %d", i)
}

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("speed." . kind)
  set multiplot title "Speed and error: one step of 5 iterations against " . base . " on one thread" \
    font ",15" noenhanced
  set label 1 footer at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced
  set tmargin at screen 1 - 75.0 / height; set bmargin at screen 75.0 / height
  set yrange [rows + 0.6:-2.9] # with room for the keys
  do for [p = 1:panels] {
    set lmargin at screen left(p); set rmargin at screen left(p + 1) - 0.02
    eval "set ytics scale 0 noenhanced font ',9' (" . (p == 1 ? labels : blanks) . ")"
    set key top right font ",9" spacing 1
    if (p < panels) {
      mesh = word(meshes, p)
      set title sprintf("%s, %s tetrahedra", mesh, tets(mesh)) noenhanced
      set xlabel "times faster (95 % interval)"
      set logscale x 2
      set xrange [0.7:64]
      set xtics (1, 2, 4, 8, 16, 32, 64) format "%g"
      plot for [i = 1:words(threads)] file(mesh, word(threads, i)) \
        using "faster":(column("row") + 0.25 * (i - 1.5)):"low":"high" with xerrorbars \
        pointtype point(i) linecolor rgb shade(i) linewidth 1.5 title in_threads(word(threads, i))
    } else {
      set title "error against the same model in ebe/f64"
      set xlabel "relative; positions after ten steps"
      unset logscale x
      set logscale x 10
      set xrange [1e-17:1e-3]
      set xtics ("10^{-16}" 1e-16, "10^{-12}" 1e-12, "10^{-8}" 1e-8, "10^{-4}" 1e-4)
      plot for [p2 = 1:words(meshes)] file(word(meshes, p2), word(threads, 1)) \
          using "force":(column("row") - 0.15) with points \
          pointtype (p2 == 1 ? 7 : 6) linecolor rgb "#000000" title "force at the start, " . word(meshes, p2), \
        for [p2 = 1:words(meshes)] file(word(meshes, p2), word(threads, 1)) \
          using "position":(column("row") + 0.15) with points \
          pointtype (p2 == 1 ? 9 : 8) linecolor rgb "#d55e00" title "position, " . word(meshes, p2)
    }
    unset label 1
  }
  unset multiplot
  unset output
}
