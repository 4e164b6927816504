# What `corobench run` filmed: a strip of pictures, and an animation. The body is its boundary,
# lit from above; faces of inverted elements are dark red; balls hold (red) and move (blue) it.
# Reads NAME-film.csv, NAME-faces.txt and NAME-grips.txt; `film` is set to NAME.
# SPDX-License-Identifier: BSD-3-Clause
load "plots/style.gp"
table = in(film . "-film.csv")
faces = in(film . "-faces.txt")
grips = in(film . "-grips.txt")
rows(condition) = system("awk -F, 'NR > 1 && (" . condition . ") {printf \"%d \", $1}' '" . table . "'")
cell(picture, field) = system(sprintf("awk -F, '$1 == \"%d\" {print $%d}' '%s'", picture, field, table))
strip = rows("$7 == 1")
pictures = words(rows("1"))

set datafile separator whitespace
set datafile nocolumnheaders
stats faces using 1 name "X" nooutput
stats faces using 2 name "Y" nooutput
stats faces using 3 name "Z" nooutput
ground = cell(0, 6)
margin = 0.04 * (X_max - X_min)
low = ground eq "" ? Z_min : real(ground)
set xrange [X_min - margin:X_max + margin]
set yrange [Y_min - margin:Y_max + margin]
set zrange [low:Z_max]
set xyplane at low
set view equal xyz
unset border; unset tics; unset key; unset colorbox
set pm3d depthorder

# As large as a panel, by its height, allows: what the view makes of the box of all pictures.
tilt = 74; turn = 26
sine(angle) = sin(angle * pi / 180); cosine(angle) = cos(angle * pi / 180)
dx = X_max - X_min + 2 * margin; dy = Y_max - Y_min + 2 * margin; dz = Z_max - low
wide = dx * cosine(turn) + dy * sine(turn)
high = dz * sine(tilt) + (dx * sine(turn) + dy * cosine(turn)) * cosine(tilt)
longest = dx > dy ? (dx > dz ? dx : dz) : (dy > dz ? dy : dz)
magnify(ratio) = 1.62 * longest / (high > wide / ratio ? high : wide / ratio)

# Upright: 0 to 1, dark to light grey; inverted: -1 to 0, red, darker than any of it.
set palette defined (-1 "#2a0000", -0.001 "#c01810", 0 "#3c4048", 0.5 "#8a8c90", 1 "#f6f0e2")
set cbrange [-1:1]
colour(shade, inverted) = inverted > 0 ? shade - 1 : shade
ball(kind) = kind > 0 ? "#1048b0" : "#d01818"
if (ground ne "") {
  set object 1 polygon from X_min - margin, Y_min - margin, low to X_max + margin, Y_min - margin, low \
    to X_max + margin, Y_max + margin, low to X_min - margin, Y_max + margin, low \
    to X_min - margin, Y_min - margin, low back fillcolor rgb "#d8dfd2" fillstyle solid noborder
}
share(n) = 100.0 * int(cell(n, 3)) / int(cell(n, 4))
caption(n) = sprintf("%.2f s", real(cell(n, 2))) . (share(n) >= 0.5 ? sprintf(", %.0f %% inverted", share(n)) : "")
# Balls are labels, which are in front of what is sorted by depth.
held(n) = system(sprintf("awk 'NF {if ($1 != \"nan\" && p == %d) print} !NF && !last {p++} {last = NF}' '%s'", n, grips))
balls_of_picture = 'lines = held(n); unset label; \
  do for [k = 1:words(lines) / 4] { \
    set label k + 1 "" at real(word(lines, 4 * k - 3)), real(word(lines, 4 * k - 2)), real(word(lines, 4 * k - 1)) \
      front point pointtype 7 pointsize balls linecolor rgb ball(int(word(lines, 4 * k))) \
  }'
draw = 'splot faces index n using 1:2:3:(colour(column(4), column(5))) with pm3d'

# ---- the strip: two rows ----
across = (words(strip) + 1) / 2
ratio = wide / high < 0.7 ? 0.7 : wide / high > 1.6 ? 1.6 : wide / high
panel = 400 # pixels wide
row = panel / ratio + 30
set terminal pngcairo size panel * across, 2 * row font "sans-serif,14" background "white"
set output in(film . ".png")
balls = 1.6
set view tilt, turn, magnify(ratio)
set multiplot
do for [i = 1:words(strip)] {
  n = int(word(strip, i))
  left = ((i - 1) % across) / real(across)
  bottom = i > across ? 0 : 0.5
  set lmargin at screen left
  set rmargin at screen left + 1.0 / across
  set bmargin at screen bottom + 15 / row
  set tmargin at screen bottom + 0.5
  eval balls_of_picture
  set label 1 caption(n) at screen left + 0.5 / across, bottom + 8 / row center front
  eval draw
}
unset multiplot
unset output

# ---- the animation ----
set terminal gif animate optimize delay 8 loop 0 size panel, row font "sans,11" background "white"
set output in(film . ".gif")
balls = 1.2
set lmargin at screen 0; set rmargin at screen 1; set bmargin at screen 30 / row; set tmargin at screen 1
do for [n = 0:pictures - 1] {
  eval balls_of_picture
  set label 1 caption(n) at screen 0.5, 15 / row center front
  eval draw
}
unset output
