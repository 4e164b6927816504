# What breaks, and where: the worst state of each model in each sweep, one panel for each
# precision (scalar and lanes together).
# Reads extremes-map.csv, extremes-footer.txt.
# SPDX-License-Identifier: BSD-3-Clause
footer_file = "extremes-footer.txt"
load "plots/style.gp"
map = quoted("extremes-map.csv")
first(column) = system("awk -F, 'NR > 1 && !seen[$" . column . "]++ {print $" . column . "}' " . map)
models = first(2)
sweeps = first(1)
total(s) = system("awk -F, '$1 == \"" . s . "\" {print $10; exit}' " . map)
precisions = "f64 f32"
# x, y, state 0 to 5, label: the worst of all arithmetics of that precision. A letter for
# the state, and how many rows are in it.
cells(p) = "< awk -F, 'NR > 1 && $4 ~ /^" . p . "/ {" . \
  "if (!($1 in x)) x[$1] = ++columns; if (!($2 in y)) y[$2] = ++lines; k = x[$1] \",\" y[$2];" . \
  "n = $6 > 1 ? $($6 + 10) : 0;" . \
  "if (!(k in rank) || $6 > rank[k]) {rank[k] = $6; count[k] = n}" . \
  "else if ($6 == rank[k] && n > count[k]) count[k] = n}" . \
  "END {print \"x,y,state,label\"; for (k in rank) print k \",\" rank[k] \",\" " . \
  "substr(\"-.miLX\", rank[k] + 1, 1) (count[k] ? count[k] : \"\")}' " . map
family(m) = system("echo " . m . " | sed -E 's/-(precomputed|updated|updated-volume|exact|lazy|tuned|tangent|tangent-clamped)$//'")

cell_w = 46.0; cell_h = 19.0
left = 235.0; between = 40.0; top = 170.0; bottom = 95.0
panel = cell_w * words(sweeps)
width = left + 2 * panel + between + 15
height = top + cell_h * words(models) + bottom
array SHADE[6] = ["#ffffff", "#ffffff", "#dde6ee", "#f2dc8c", "#e07b30", "#6b0f1a"]
array MEANING[6] = ["- not judged", ". right", "m by method: the note says why", "i inaccurate: more than 1000 roundings times the condition", \
  "L breaks a law that it claims", "X not finite"]

rowlabels = ""; blanks = ""; columns = ""
do for [i = 1:words(models)] {
  rowlabels = rowlabels . (i > 1 ? ", " : "") . sprintf("'%s' %d", word(models, i), i)
  blanks = blanks . (i > 1 ? ", " : "") . sprintf("'' %d", i)
}
do for [i = 1:words(sweeps)] {
  columns = columns . (i > 1 ? ", " : "") . sprintf("'%s (%s)' %d", word(sweeps, i), total(word(sweeps, i)), i)
}

do for [kind in "svg png"] {
  eval do_open(kind)
  set output in("extremes." . kind)
  set multiplot title "What breaks, and where: the worst state in each sweep (how many rows), and in how many rows it is met" \
    font ",14" noenhanced
  set label 1 footer at screen 0.01, 0.012 font ",8" textcolor "#606060" noenhanced
  unset key
  unset grid
  set border 0
  set yrange [words(models) + 0.5:0.5]
  set xrange [0.5:words(sweeps) + 0.5]
  eval "set x2tics scale 0 rotate by 60 left font ',9' noenhanced (" . columns . ")"
  unset xtics
  do for [i = 2:words(models)] {
    if (family(word(models, i)) ne family(word(models, i - 1))) {
      set arrow 100 + i from graph 0, first i - 0.5 to graph 1, first i - 0.5 nohead front linecolor "#404040" linewidth 1.2
    }
  }
  at = 20
  do for [i = 1:6] {
    set object 10 + i rectangle at screen at / width, screen 62.0 / height size screen 16.0 / width, \
      screen 14.0 / height fillcolor rgb SHADE[i] fillstyle solid border linecolor "#404040"
    set label 10 + i MEANING[i] at screen (at + 14.0) / width, screen 62.0 / height font ",10" noenhanced
    at = at + 50 + 7.2 * strlen(MEANING[i])
  }
  do for [p = 1:2] {
    x = left + (p - 1) * (panel + between)
    set lmargin at screen x / width; set rmargin at screen (x + panel) / width
    set tmargin at screen 1 - top / height; set bmargin at screen bottom / height
    eval "set ytics scale 0 noenhanced font ',9' (" . (p == 1 ? rowlabels : blanks) . ")"
    set label 2 word(precisions, p) . ", scalar and in lanes" at graph 0.5, screen 1 - 42.0 / height center font ",12"
    plot for [s = 0:5] cells(word(precisions, p)) \
        using (column("state") == s ? column("x") : NaN):"y":(0.5):(0.5) with boxxyerror \
        fillcolor rgb SHADE[s + 1] fillstyle solid border linecolor "#c0c0c0", \
      cells(word(precisions, p)) using (column("state") < 5 ? column("x") : NaN):"y":(strcol("label")) \
        with labels font ",8" textcolor "#000000" noenhanced, \
      cells(word(precisions, p)) using (column("state") == 5 ? column("x") : NaN):"y":(strcol("label")) \
        with labels font ",8" textcolor "#ffffff" noenhanced
    unset label 1 # once is enough
    unset for [i = 11:16] label i
  }
  unset multiplot
  unset output
}
