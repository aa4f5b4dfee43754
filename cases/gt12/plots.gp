# SPDX-License-Identifier: GPL-3.0-or-later
# Figs 8, 9, 11-13, 15, 17, 20-23 and 25 of the paper, from the data that targets.awk and paths.awk write:
#     gnuplot -e "out='results/gt12'" cases/gt12/plots.gp
set grid
array types[2] = ["svg", "png"]
array terminals[2] = ["svg size 900,480 background 'white'", "pngcairo size 900,480"]
array names[4] = ["kn", "kt", "bn", "bt"]
array titles[4] = ["K_n", "K_t", "B_n", "B_t"]
array pressures[6] = ["110", "130", "150", "170", "190", "210"]
file(name) = out."/".name.".dat"
do for [i = 1:2] {
    eval "set terminal ".terminals[i]
    set key left top
    set logscale xy 2
    set xlabel "part of Table 1's value"
    set output out."/disc.".types[i]
    set multiplot layout 1,2
    set ylabel "{/Symbol s}_t, part of that of Table 1"
    plot for [k = 1:4] file("strength_".names[k]) with yerrorlines lc k pt 7 title titles[k], \
        file("strength_eps_th") with yerrorlines lc 5 pt 7 title "{/Symbol e}_{th}"
    set ylabel "S, part of that of Table 1"
    plot for [k = 1:4] file("slope_".names[k]) with yerrorlines lc k pt 7 title titles[k]
    unset multiplot
    set output out."/elastic.".types[i]
    set multiplot layout 1,3
    unset logscale y
    set ylabel "{/Symbol n}, part of that of Table 1"
    plot for [k = 1:4] file("nu_".names[k]) with yerrorlines lc k pt 7 title titles[k]
    set logscale y 2
    set ylabel "E_c, part of that of Table 1"
    plot for [k = 1:4] file("e_c_".names[k]) with yerrorlines lc k pt 7 title titles[k]
    set ylabel "E_t, part of that of Table 1"
    plot for [k = 1:4] file("e_t_".names[k]) with yerrorlines lc k pt 7 title titles[k]
    unset multiplot
    unset logscale
    set output out."/paths.".types[i]
    set multiplot layout 1,2
    set key right bottom
    set xlabel "{/Symbol e}_d"
    set ylabel "q [MPa]"
    plot for [k = 1:6] file("path_envelope_".pressures[k]) using 1:2 with lines lc k title pressures[k]." MPa", \
        for [k = 1:6] file("path_unbonded_".pressures[k]) using 1:2 with lines lc k dt 2 notitle
    set key left top
    set ylabel "{/Symbol e}_v, compression positive"
    plot for [k = 1:6] file("path_envelope_".pressures[k]) using 1:3 with lines lc k title pressures[k]." MPa", \
        for [k = 1:6] file("path_unbonded_".pressures[k]) using 1:3 with lines lc k dt 2 notitle
    unset multiplot
    set output out."/envelope.".types[i]
    set xlabel "p [MPa]"
    set ylabel "q [MPa]"
    plot [0:220][0:*] file("q_envelope") with yerrorlines lc 1 pt 7 title "Table 1 as printed", \
        file("q_unbonded") with yerrorlines lc 2 pt 7 title "without bonds", \
        file("q_scan") with yerrorlines lc 3 pt 7 title "{/Symbol m} = 0, {/Symbol e}_{th} = 0.0005", \
        file("q_rival") with yerrorlines lc 4 pt 7 title "VGCM-3D, its own granite set", \
        (sqrt(203.3 ** 2 + 36 * 203.3 * x + 36 * 69.3 ** 2) - 203.3) / 6 with lines lc 0 dt 2 title "the paper's fit, eq 31"
    set output out."/beam.".types[i]
    set xlabel "along the beam [m]"
    set ylabel "deflection [mm]"
    set yrange [*:*] reverse
    set key left bottom
    plot file("profile") using 1:2 with points pt 7 lc 1 title "ours", \
        file("profile") using 1:3 with lines lc 2 title "Euler, the same E_c", \
        file("profile") using 1:(6e4 * $1 ** 2 * (1.5 - $1) / (6 * 674e9 * 0.05 ** 4 / 12) * 1e3) with lines lc 0 dt 2 title "eq 29 with 674 GPa"
    set yrange [*:*] noreverse
    set output out."/breaks.".types[i]
    set xlabel "strain along the axis"
    set ylabel "q [MPa]"
    set y2label "broken bonds"
    set y2tics
    set key right bottom
    plot file("path_envelope_110") using 4:2 with lines lc 1 title "q, p = 110 MPa", \
        file("path_envelope_110") using 4:5 axes x1y2 with lines lc 2 title "broken bonds"
    unset y2label
    unset y2tics
    set output out."/areas.".types[i]
    set xlabel "area of a facet between two grains [cm^2]"
    set ylabel "facets"
    set datafile separator ","
    plot [0:2.5] out."/areas.csv" using 1:2 skip 1 with boxes lc 1 notitle
    set datafile separator
}
