# Which models come back from which start: a box for each, the darker the less has come back.
# Reads recovery.csv, recovery-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "recovery-footer.txt"
load "plots/style.gp"
set datafile missing "?" # NaN is a text to be shown
models = system("awk -F, 'NR > 1 && !seen[$2]++ {print $2}' " . quoted("recovery.csv"))
starts = int(system("awk -F, 'NR > 1 && !seen[$1]++ {n++} END {print n}' " . quoted("recovery.csv")))
rows = words(models)
width = 280 + 66 * starts
height = 190 + 21 * rows

# x, y, share, text of every box; the text is white on dark ones (which: dark or light).
boxes(which) = "< awk -F, -v which=" . which . " '" . \
  "NR == 1 {print \"x,y,share,text\"; next} " . \
  "!($1 in x) {x[$1] = ++nx} !($2 in y) {y[$2] = ++ny} " . \
  "{text = $4 == \"recovered\" ? sprintf(\"%.2f s\", $9) : " . \
  "$4 == \"stuck\" ? sprintf(\"%d %%\", 100 * $5) : $4; " . \
  "share = $4 == \"mirrored\" ? 0.5 : $4 == \"stuck\" ? 0.3 + 0.5 * $5 : $5; " . \
  "if (which == \"all\" || (which == \"dark\") == (share < 0.45)) " . \
  "print x[$1] \",\" y[$2] \",\" share \",\" text}' " . quoted("recovery.csv")
start(i) = system("awk -F, 'NR > 1 && !seen[$1]++ {print $1}' " . quoted("recovery.csv") . " | sed -n " . i . "p")

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("recovery." . kind)
  set label 1 footer at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced
  set label 2 "one tetrahedron, pushed through itself to half its height" \
    at first 4.5, graph 1 center offset 0, 3.3
  set label 3 "a block of 270 tetrahedra" at first starts - 2, graph 1 center offset 0, 3.3
  set label 4 "Time until all elements are at rest and right-handed; else their share, or what becomes of the body. NaN: a position is not finite." \
    at screen 0.5, 0.04 center font ",10"
  set title "Which models come back?" font ",14" offset 0, 2.6
  set lmargin at screen 265.0 / width
  set rmargin at screen 1 - 15.0 / width
  set tmargin at screen 1 - 105.0 / height
  set bmargin at screen 75.0 / height
  set xrange [0.5:starts + 0.5]
  set yrange [rows + 0.5:0.5]
  unset xtics
  unset ytics
  set x2range [0.5:starts + 0.5]
  set x2tics scale 0 offset 0, -0.3 font ",10" ("" 0)
  set ytics scale 0 ("" 0)
  do for [i = 1:starts] { set x2tics add (start(i) i) }
  do for [i = 1:rows] { set ytics add (word(models, i) i) }
  unset grid
  unset border
  unset key
  unset colorbox
  set palette defined (0 "#303030", 0.3 "#707070", 0.5 "#b8b8b8", 0.8 "#d8d8d8", 1 "#f6f6f6")
  set cbrange [0:1]
  set style fill solid 1 noborder
  set arrow 1 from 8.5, 0.3 to 8.5, rows + 0.7 nohead linecolor "#000000" linewidth 1.5
  plot boxes("all") using "x":"y":(0.48):(0.46):"share" with boxxyerror fillcolor palette, \
    boxes("dark") using "x":"y":(strcol("text")) with labels textcolor "#ffffff" font ",9" noenhanced, \
    boxes("light") using "x":"y":(strcol("text")) with labels textcolor "#000000" font ",9" noenhanced
  unset output
}
