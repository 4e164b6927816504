# How much of the block has come back, against time.
# Reads recovery-time.csv, recovery-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "recovery-footer.txt"
load "plots/style.gp"
width = 1200
height = 460
# One of each kind; the others of a kind lie on its line.
wanted = "qr-precomputed qr-exact qr-updated polar-closed-precomputed polar-closed-updated " . \
  "polar-tangent svd-precomputed node-warp green polar-reflected-precomputed"
have = system("awk -F, 'NR > 1 && !seen[$2]++ {printf \"%s \", $2}' " . quoted("recovery-time.csv"))
chosen = ""
do for [m in wanted] { if (strstrt(" " . have, " " . m . " ")) { chosen = chosen . " " . m } }
if (words(chosen) == 0) { chosen = have }
rows(s, m) = "< awk -F, 'NR == 1 || ($1 == \"" . s . "\" && $2 == \"" . m . "\")' " . \
  quoted("recovery-time.csv")

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("recovery-time." . kind)
  set multiplot layout 1, 2 title "How much of a block has come back: 270 tetrahedra, E = 10 kPa, 0.3 m" font ",14"
  set label 1 footer at screen 0.01, 0.02 font ",8" textcolor "#606060" noenhanced
  set bmargin at screen 0.17
  set tmargin at screen 0.84
  set xlabel "time, s"
  set xrange [0:4]
  set yrange [-3:103]
  set ylabel "elements at rest and right-handed, %"
  set lmargin at screen 0.06
  set rmargin at screen 0.39
  set key at screen 0.775, 0.82 left top vertical noenhanced
  set title "mirrored in a plane"
  plot for [i = 1:words(chosen)] rows("mirrored", word(chosen, i)) \
    using "time_s":(100 * column("back")) with linespoints linestyle i pointinterval 12 \
    title word(chosen, i)
  unset label 1
  unset key
  unset ylabel
  set lmargin at screen 0.435
  set rmargin at screen 0.765
  set title "all nodes at random places"
  plot for [i = 1:words(chosen)] rows("random", word(chosen, i)) \
    using "time_s":(100 * column("back")) with linespoints linestyle i pointinterval 12
  unset multiplot
  unset output
}
