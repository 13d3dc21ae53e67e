# Draws the figures for scripts/paper-figures from the CSV files in the present folder. Colours: Okabe and Ito.
set datafile separator ","
set grid lc rgb "#dddddd"
set border lc rgb "#444444"
set key outside right top Left reverse samplen 3
set tics nomirror
black = "#000000"; grey = "#999999"; orange = "#e69f00"; sky = "#56b4e9"; green = "#009e73"
blue = "#0072b2"; red = "#d55e00"; purple = "#cc79a7"

set terminal svg size 900,620 font "sans-serif,13" background "white"
set output "figure5.svg"
set multiplot layout 2,1 title "Figure 5: Table 1's rig, sine 0.1 Hz, healthy and leaking (C = 0.7, 0.5 mm^2)"
set lmargin 10; set rmargin 22
set ylabel "position / mm"; set xlabel ""
plot "figure5.csv" using 1:2 with lines lw 1.5 dt 3 lc rgb grey title "reference", \
     "" using 1:3 with lines lw 2.5 lc rgb blue title "healthy", \
     "" using 1:4 with lines lw 2 dt 2 lc rgb red title "leaking"
set ylabel "residual / mm"; set xlabel "time / s"
plot "figure5.csv" using 1:5 with lines lw 2 lc rgb black title "leaking - healthy"
unset multiplot

set terminal svg size 900,460 font "sans-serif,13" background "white"
set lmargin 10; set rmargin 22; set xlabel "time / s"
set output "figure8.svg"
set title "Figure 8: position at four openings, sine 0.1 Hz"
set ylabel "position / mm"
plot "figure8.csv" using 1:2 with lines lw 1.5 dt 3 lc rgb grey title "reference", \
     "" using 1:3 with lines lw 2 lc rgb black title "none (0 %)", \
     "" using 1:4 with lines lw 2 dt 5 lc rgb sky title "slight (33 %)", \
     "" using 1:5 with lines lw 2 dt 2 lc rgb orange title "medium (66 %)", \
     "" using 1:6 with lines lw 2 dt 4 lc rgb red title "critical (100 %)"

set output "figure9.svg"
set title "Figure 9: flows with 30 % of the servo flow leaking (C = 0.6), sine 0.1 Hz"
set ylabel "flow / (L/min)"; set yrange [-4.5:4.5]
plot "figure9.csv" using 1:2 with lines lw 2 lc rgb blue title "servo valve", \
     "" using 1:3 with lines lw 2 dt 2 lc rgb red title "leakage", \
     "" using 1:4 with lines lw 2 dt 4 lc rgb green title "work"

set output "figure10.svg"
set autoscale y
set title "Figure 10: position at five leak levels, sine 0.1 Hz"
set ylabel "position / % of the amplitude"
plot "figure10.csv" using 1:2 with lines lw 1.5 dt 3 lc rgb grey title "reference", \
     "" using 1:3 with lines lw 2 lc rgb black title "Normal", \
     "" using 1:4 with lines lw 2 dt 5 lc rgb sky title "Slight", \
     "" using 1:5 with lines lw 2 dt 2 lc rgb orange title "Medium", \
     "" using 1:6 with lines lw 2 dt 4 lc rgb red title "Critical", \
     "" using 1:7 with lines lw 2 dt 6 lc rgb purple title "Super"

set terminal svg size 900,820 font "sans-serif,13" background "white"
set output "figure11.svg"
unset title
set multiplot layout 3,1 title "Figure 11: flows at three leak levels, sine 0.1 Hz"
set ylabel "flow / (L/min)"; set yrange [-4.5:4.5]
do for [i=0:2] {
  set xlabel i == 2 ? "time / s" : ""
  set title word("10 20 30", i + 1)." % of the servo flow leak" offset 0,-0.6
  plot "figure11.csv" using 1:(column(2 + 3 * i)) with lines lw 2 lc rgb blue title "servo valve", \
       "" using 1:(column(3 + 3 * i)) with lines lw 2 dt 2 lc rgb red title "leakage", \
       "" using 1:(column(4 + 3 * i)) with lines lw 2 dt 4 lc rgb green title "work"
}
unset multiplot
