# What the plots have in common; loaded by each, which is run from the root of
# the project with `results` set to a directory that bench or verify wrote.
# SPDX-License-Identifier: BSD-3-Clause
if (!exists("results")) results = "results/latest"
in(name) = results . "/" . name
quoted(name) = "'" . in(name) . "'" # for the shell
# figure3.gp: what verify wrote; the others: what bench wrote.
if (!exists("footer_file")) footer_file = "footer.txt"
footer = system("head -n 1 " . quoted(footer_file) . " 2>/dev/null")

# The groups that figures 4 and 7 draw one plot of each: those columns of bench.csv, joined.
group_list(figure, key) = system("awk -F'[,/]' '$1 == " . figure . " && $9 > 0 && !seen[" . key . \
  "]++ {print " . key . "}' " . quoted("bench.csv"))
part(group, n) = system("echo '" . group . "' | cut -d@ -f" . n)
many_lanes(arithmetic) = strstrt(arithmetic, "x") > 0
in_threads(threads) = threads eq "1" ? "one thread" : threads . " threads"

set encoding utf8
set datafile separator comma
set datafile columnheaders
set datafile missing NaN # what a filter leaves out does not interrupt a line
set termoption noenhanced
set border linecolor "#404040"
set tics nomirror
set grid linecolor "#dddddd" linetype 1 linewidth 0.5
set key reverse Left samplen 4 spacing 1.15

# Told apart by dash and point as well as by colour, dark enough on white.
set style line 1 linecolor "#000000" dashtype 1 pointtype 7 linewidth 2 pointsize 1.0
set style line 2 linecolor "#0072b2" dashtype 2 pointtype 5 linewidth 2 pointsize 1.0
set style line 3 linecolor "#d55e00" dashtype 4 pointtype 9 linewidth 2 pointsize 1.2
set style line 4 linecolor "#009e73" dashtype 5 pointtype 4 linewidth 2 pointsize 1.2
set style line 5 linecolor "#a0408a" dashtype "__ " pointtype 13 linewidth 2 pointsize 1.3
set style line 6 linecolor "#707070" dashtype 6 pointtype 8 linewidth 2 pointsize 1.2
set style line 7 linecolor "#b08000" dashtype "-..-" pointtype 6 linewidth 2 pointsize 1.2
set style line 8 linecolor "#000000" dashtype 3 pointtype 6 linewidth 1.5 pointsize 0.9
set style line 9 linecolor "#0072b2" dashtype 1 pointtype 12 linewidth 1.5 pointsize 1.2
set style line 10 linecolor "#d55e00" dashtype 2 pointtype 10 linewidth 1.5 pointsize 1.2
set style line 11 linecolor "#404040" dashtype "._" pointtype 11 linewidth 1.5 pointsize 1.2
# What the paper says.
set style line 20 linecolor "#b00000" dashtype "." linewidth 2.5

# Open name.svg or name.png in the results directory.
open_svg = 'set terminal svg size width,height dynamic enhanced font "sans-serif,11" background "white"'
open_png = 'set terminal pngcairo size width,height enhanced font "sans-serif,11" background "white"'
do_open(kind) = kind eq "svg" ? open_svg : open_png
