# Draws velocity_estimators.svg: gnuplot velocity_estimators.gp, in this folder. The numbers are of
# tandem_velocity_estimators: lag at 3 Hz [ms], noise in a stroke of 100 mm/s with uneven, unstamped
# readings [mm/s], stiffest wall with forces a period late [N/m], name.
$low_pass << END
 0.5  34.4  14578  "difference"
 1.4  15.0   9957  "120 Hz"
 2.7   8.3   6801  "60 Hz"
 5.3   4.4   3839  "30 Hz"
10.5   2.5   1970  "15 Hz"
END
$observer << END
 2.5   6.6   6183  "0.5"
 3.5   4.3   4645  "0.6"
 5.2   2.6   3173  "0.7"
END
$published << END
 1.1  23.1  13253  "0.5"
 2.1  19.8   9957  "0.7"
 4.9   7.5   1791  "1"
 6.2   1.8   1628  "1.5"
END
$usual << END
 3.3   4.2   7481  "usual"
 5.2   2.7   9052  "16 ms"
END

set encoding utf8
set terminal svg size 900,420 dynamic noenhanced font 'sans-serif,13' background 'white'
set output 'velocity_estimators.svg'
set multiplot layout 1,2 margins 0.08,0.98,0.13,0.80 spacing 0.1
set grid lc rgb '#dddddd'
set logscale y
set yrange [1.2:50]
set ylabel 'noise at 100 mm/s, uneven readings [mm/s]'
set style line 1 lc rgb '#888888' lw 2 pt 7 ps 0.6
set style line 2 lc rgb '#1f77b4' lw 2 pt 5 ps 0.6
set style line 3 lc rgb '#2ca02c' lw 2 pt 9 ps 0.8
set style line 4 lc rgb '#d62728' lw 2 pt 7 ps 1.0
set xlabel 'lag at 3 Hz [ms]'
set xrange [0:12]
unset key
set ytics (2, 5, 10, 20, 50)
set label 1 'first difference, and low-pass by cut-off' at screen 0.08,0.95 tc rgb '#666666'
set label 2 'alpha-beta observer by memory' at screen 0.08,0.89 tc rgb '#1f77b4'
set label 3 'adaptive window of 16 ms by tolerance [counts]' at screen 0.55,0.95 tc rgb '#2ca02c'
set label 4 'the same with a stamp error: usual, 8 ms' at screen 0.55,0.89 tc rgb '#d62728'
plot $low_pass u 1:2 w lp ls 1, \
     $observer u 1:2 w lp ls 2, \
     $published u 1:2 w lp ls 3, \
     $usual u 1:2 w lp ls 4, \
     $low_pass u 1:2:4 w labels left offset 0.7,0.5 tc rgb '#666666', \
     $observer u 1:2:4 w labels right offset -0.7,-0.5 tc rgb '#1f77b4', \
     $published u 1:2:4 w labels left offset 0.7,0.5 tc rgb '#2ca02c', \
     $usual u 1:2:4 w labels left offset 0.7,0.6 tc rgb '#d62728'
set xlabel 'stiffest calm wall, forces a period late [kN/m]'
set xrange [0:16]
unset for [i=1:4] label i
unset ylabel
plot $low_pass u ($3/1e3):2 w lp ls 1, $observer u ($3/1e3):2 w lp ls 2, $published u ($3/1e3):2 w lp ls 3, \
     $usual u ($3/1e3):2 w lp ls 4, \
     $low_pass u ($3/1e3):2:4 w labels right offset -0.9,0.5 tc rgb '#666666', \
     $observer u ($3/1e3):2:4 w labels left offset 0.7,-0.5 tc rgb '#1f77b4', \
     $published u ($3/1e3):2:4 w labels left offset 0.7,0.5 tc rgb '#2ca02c', \
     $usual u ($3/1e3):2:4 w labels left offset 0.9,0 tc rgb '#d62728'
unset multiplot
set output
system("sed -i 's/\\t/ /g; s/ *$//' velocity_estimators.svg")  # as the house has its text files
