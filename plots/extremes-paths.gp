# Elements turned inside out: how far the frame has turned, and the force, along each path.
# Reads extremes-paths.csv, extremes-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "extremes-footer.txt"
load "plots/style.gp"
width = 1400
height = 1560
paths = "vertex_a vertex_b vertex_c vertex_d edge_ab edge_ac edge_ad centre vertex_d_straight"
in_words(p) = system("echo '" . p . "' | tr _ ' '")
rows(p, m) = "< awk -F, 'NR == 1 || ($1 == \"" . in_words(p) . "\" && $3 == \"" . m . "\")' " . \
  quoted("extremes-paths.csv")
frames = "qr-updated svd-updated polar-reflected-updated"
forces = "green qr-updated qr-exact svd-updated polar-closed-precomputed polar-quaternion-updated polar-reflected-updated"
style_of(m) = m eq "qr-updated" ? 3 : m eq "svd-updated" ? 1 : m eq "polar-reflected-updated" ? 5 : \
  m eq "qr-exact" ? 10 : m eq "polar-closed-precomputed" ? 2 : m eq "polar-quaternion-updated" ? 4 : 6
gap = 50.0
panel_w = (width - 75 - 2 * gap - 15) / 3.0
panel_h = (height - 70 - 90 - 5 * 44) / 6.0

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("extremes-paths." . kind)
  set multiplot title "Turned inside out: a jump is a vertical line. Flat at 1/3 (dashed)" font ",15" noenhanced
  set label 1 footer at screen 0.01, 0.008 font ",8" textcolor "#606060" noenhanced
  set grid
  set xrange [0:1]
  set xtics 0.2
  set arrow 1 from 1.0 / 3, graph 0 to 1.0 / 3, graph 1 nohead dashtype 3 linecolor "#404040"
  do for [n = 1:9] {
    p = word(paths, n)
    column_n = (n - 1) % 3
    x = 75 + column_n * (panel_w + gap)
    set lmargin at screen x / width; set rmargin at screen (x + panel_w) / width
    do for [what = 0:1] {
      line_n = 2 * ((n - 1) / 3) + what
      y = height - 70 - line_n * (panel_h + 44)
      set tmargin at screen y / height; set bmargin at screen (y - panel_h) / height
      set title (what ? "force / (E L^2)" : "frame: degrees turned") . ", through " . in_words(p) font ",10" noenhanced offset 0, -0.6
      if (n == 1) { set key top right font ",8" noenhanced } else { unset key }
      if (what) {
        set yrange [0:*]; set ytics autofreq
        plot for [m in forces] rows(p, m) using "t":"force_per_EL2" with lines linestyle style_of(m) title m
      } else {
        set yrange [-5:185]; set ytics 45
        plot for [m in frames] rows(p, m) using "t":"frame_turned_deg" with lines linestyle style_of(m) title m
      }
    }
  }
  unset multiplot
  unset output
}
