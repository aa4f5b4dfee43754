# SPDX-License-Identifier: GPL-3.0-or-later
# Figs 5 to 7 of the paper, from the data that targets.awk writes and the curves of `pictures`:
#     gnuplot -e "out='results/vgcm'" cases/vgcm/plots.gp
set grid
array types[2] = ["svg", "png"]
array terminals[2] = ["svg size 720,480 background 'white'", "pngcairo size 720,480"]
do for [i = 1:2] {
    eval "set terminal ".terminals[i]
    set output out."/envelope.".types[i]
    set key left top
    set xlabel "confining pressure [MPa]"
    set ylabel "{/Symbol s}_1 at the peak [MPa]"
    plot [-0.5:12.5] out."/envelope_softening.dat" with yerrorlines lc 1 pt 7 title "softening, ours", \
        124.6 + 6.318 * x with lines lc 1 dt 2 title "softening, paper (c, {/Symbol f})", \
        out."/envelope_brittle.dat" with yerrorlines lc 2 pt 7 title "brittle, ours", \
        125.2 + 5.342 * x with lines lc 2 dt 2 title "brittle, paper", \
        125.5 + 8.933 * x with lines lc 3 dt 3 title "Augig granite"
    set output out."/elastic.".types[i]
    set key right center
    set xlabel "{/Symbol h}, shear stiffness over normal stiffness"
    set ylabel "E over E-bar; {/Symbol n}"
    plot [-0.05:1.05][0:1.1] out."/modulus.dat" with yerrorlines lc 1 pt 7 title "E over E-bar", \
        (2 + 3 * x) / (4 + x) with lines lc 1 dt 2 title "uniform strain, all facets", \
        out."/poisson.dat" with yerrorlines lc 2 pt 7 title "{/Symbol n}", \
        (1 - x) / (4 + x) with lines lc 2 dt 2 title "uniform strain"
    set output out."/curves.".types[i]
    set key outside right
    set xlabel "platen strain [%]"
    set ylabel "{/Symbol s}_1 - {/Symbol s}_3 [MPa]"
    set datafile separator ","
    curve(p, law) = out."/curve_".(p ? sprintf("triaxial_%d", p) : "compression")."_".law.".csv"
    plot [0:2] for [p = 0:12:3] curve(p, "softening") skip 1 using ($1 * 100):($2 * 1e-6) with lines lc p / 3 + 1 title sprintf("softening, %d MPa", p), \
        for [p = 0:12:3] curve(p, "brittle") skip 1 using ($1 * 100):($2 * 1e-6) with lines lc p / 3 + 1 dt 2 title sprintf("brittle, %d MPa", p)
    set datafile separator
}
