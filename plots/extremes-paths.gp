# Elements turned inside out: how far the frame has turned, and the force, along each path.
# Reads extremes-paths.csv, extremes-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "extremes-footer.txt"
load "plots/style.gp"
width = 1400
height = 1640
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
panel_h = (height - 60 - 150 - 5 * 50) / 6.0

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("extremes-paths." . kind)
  set multiplot title "Turned inside out: frame and force along the way, flat at 1/3 (dotted). A vertical line or a spike is a jump; force: / (E L^2), 150 steps" font ",15" noenhanced
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
      y = height - 60 - line_n * (panel_h + 50)
      set tmargin at screen y / height; set bmargin at screen (y - panel_h) / height
      set title (what ? "change of the force in a step" : "degrees that the frame has turned") . \
        ", through " . in_words(p) font ",10" noenhanced offset 0, -0.7
      unset key
      if (what) {
        set logscale y; set format y "10^{%T}"; set yrange [1e-5:10]; set ytics 100; unset mytics
        plot for [m in forces] rows(p, m) using "t":"force_step_per_EL2" with lines linestyle style_of(m)
        unset logscale y; set format y "%g"
      } else {
        set yrange [-5:185]; set ytics 45
        plot for [m in frames] rows(p, m) using "t":"frame_turned_deg" with lines linestyle style_of(m)
      }
      unset label 1 # once is enough
    }
  }
  # One key for all, below.
  unset arrow 1
  unset grid; unset border; unset tics; unset title
  set lmargin at screen 0.05; set rmargin at screen 0.95
  set tmargin at screen 105.0 / height; set bmargin at screen 30.0 / height
  set yrange [0:1]
  set key at graph 0.5, graph 0.9 center top maxrows 3 font ",11" noenhanced
  plot for [m in forces] NaN with lines linestyle style_of(m) title m . \
    (m eq "polar-reflected-updated" ? " (90: reflected)" : m eq "green" ? " (force only)" : m eq "svd-updated" ? \
    " (frame: every polar)" : "")
  unset multiplot
  unset output
  set border 31 linecolor "#404040"; set tics nomirror; set ytics; set xtics
}
