# SPDX-License-Identifier: GPL-3.0-or-later
# The numbers and claims of the paper on VGCM-3D beside ours; see cases/paper.awk.

# c and phi (eq 31's line through sigma_1 at all pressures), pack by pack
function mohr_coulomb(law, cohesion, angle,    s, y, k, p, n, sx, sy, sxx, sxy, m, slope) {
    split("", cohesion)
    split("", angle)
    split("", s)
    packs("group=table2;test=compression;law=" law, "strength", s)
    for (k in s) {
        n = 1
        sx = sxx = sxy = 0
        sy = s[k]
        for (p = 3; p <= 12; p += 3)
            if (packs("group=confined;law=" law ";triaxial.pressure=" p " MPa;specimen.seed=" k, "sigma_1", y)) {
                n++
                sx += p
                sxx += p * p
                sy += y[k]
                sxy += p * y[k]
            }
        if (n < 5)
            continue
        slope = (n * sxy - sx * sy) / (n * sxx - sx * sx) / 1e6 # tan^2(45 + phi / 2)
        m = (sy - 1e6 * slope * sx) / n
        cohesion[k] = m / (2 * sqrt(slope))
        angle[k] = 2 * atan2(sqrt(slope), 1) * 180 / pi - 90
    }
}

function law_of_table2(law, paper_of,    x, y, z, k, p, choices, tension, brazilian) {
    choices = law == "softening" ? "group=choices;test=" : "group=brittle;test="
    packs("group=table2;test=compression;law=" law, "E", x)
    target("E, " law, "Table 2", 25.8, 0, "GPa", 1e-9, x, choices "compression;choice=", "E")
    packs("group=table2;test=compression;law=" law, "nu", x)
    target("nu, " law, "Table 2", 0.23, 0, "", 1, x, choices "compression;choice=", "nu")
    packs("group=table2;test=compression;law=" law, "strength", x)
    target("unconfined strength, " law, "Table 2", paper_of["ucs"], 0, "MPa", 1e-6, x, choices "compression;choice=", "strength")
    packs("group=table2;test=tension;law=" law, "strength", tension)
    target("direct tension, " law, "Table 2", paper_of["direct"], 0, "MPa", 1e-6, tension, choices "tension;choice=", "strength")
    packs("group=table2;test=brazilian;law=" law, "strength", brazilian)
    target("Brazilian strength, " law, "Table 2", paper_of["indirect"], 0, "MPa", 1e-6, brazilian, choices "brazilian;choice=", "strength")
    ratio(tension, brazilian, z)
    target("direct / Brazilian, " law, "Table 2", sprintf("%.3f", paper_of["direct"] / paper_of["indirect"]), 0, "", 1, z)
    mohr_coulomb(law, y, z)
    target("cohesion, " law, "Table 2", paper_of["c"], 0, "MPa", 1e-6, y)
    target("friction angle, " law, "Table 2", paper_of["phi"], 0, "deg", 1, z)
    for (p = 3; p <= 12; p += 3) {
        packs("group=confined;law=" law ";triaxial.pressure=" p " MPa", "sigma_1", x)
        target("sigma_1 at " p " MPa, " law, "Fig 6, from c and phi", paper_of[p], 0, "MPa", 1e-6, x)
    }
}

# "name value name value": what the paper gives; 3 to 12 are sigma_1 [MPa] at that pressure
function read_paper(list, paper_of,    word, n, i) {
    n = split(list, word, " ")
    for (i = 1; i < n; i += 2)
        paper_of[word[i]] = word[i + 1]
}

function table2(    paper_of) {
    choices_of("as read|energies of the print|kink at a third|linear softening|damage by strength|gap of 0.7 mm|gap of 1 mm|all facets|large facets|exact points|one point|looser packing|damping of all motion|damping along the velocity|half the target|a quarter of the target|damping of all motion by 0.3")
    read_paper("ucs 124.5 direct 7.4 indirect 9.1 c 24.8 phi 46.6 3 143.6 6 162.5 9 181.5 12 200.4", paper_of)
    law_of_table2("softening", paper_of)
    read_paper("ucs 125.2 direct 16.4 indirect 8.9 c 27.1 phi 43.2 3 141.3 6 157.3 9 173.3 12 189.3", paper_of)
    law_of_table2("brittle", paper_of)
}

# strain from the peak until the load has fallen to half, over that of the peak
function ductility(place, z,    x, y, k) {
    packs(place, "strain_at_end", x)
    packs(place, "strain_at_peak", y)
    ratio(x, y, z)
    for (k in z)
        z[k] -= 1
}

function conclusions(    x, y, z, k, m, direct, indirect, low, high) {
    packs("group=table2;law=softening;test=tension", "strength", direct)
    packs("group=table2;law=softening;test=brazilian", "strength", indirect)
    ratio(direct, indirect, z)
    claim("softening brings direct / Brazilian below 1", "conclusions", "below 1", mean(z) + 2 * se_of < 1, z, 1, "")
    packs("group=table2;law=brittle;test=tension", "strength", direct)
    packs("group=table2;law=brittle;test=brazilian", "strength", indirect)
    ratio(direct, indirect, z)
    claim("the brittle law cannot: far above 1", "conclusions", "above 1.3", mean(z) - 2 * se_of > 1.3, z, 1, "")

    ductility("group=table2;law=softening;test=compression", z)
    claim("softening stays brittle in compression", "Fig 7", "half of the load is lost within half of the peak's strain", mean(z) < 0.5, z, 1, "of it")
    ductility("group=table2;law=brittle;test=compression", x)
    low = mean(x)
    claim("it is less brittle than the brittle law", "Fig 7", "the brittle law loses half of its load sooner", low < mean(z), x, 1, "of the peak's strain")
    low = mean(z)
    ductility("group=confined;law=softening;triaxial.pressure=12 MPa", y)
    claim("confinement makes it more ductile", "Fig 7", "at 12 MPa half of the load is lost later than at 0", mean(y) - 2 * se_of > low, y, 1, "of the peak's strain")
    packs("group=table2;law=brittle;test=compression", "drop_before_peak", x)
    packs("group=table2;law=softening;test=compression", "drop_before_peak", y)
    high = mean(y)
    claim("the brittle law's curve has an inflection below its peak", "Fig 7", "the load falls by more than 2 % before it, and the softening law's by less", mean(x) > 0.02 && high < mean(x), x, 100, "%")

    packs("group=table2;law=softening;test=compression", "crack_angle", x)
    claim("compression: vertical cracks", "Fig 8a", "mean angle to the load below 30 deg (57 at random)", mean(x) < pi / 6, x, 180 / pi, "deg")
    packs("group=confined;law=softening;triaxial.pressure=9 MPa", "localisation_angle", x)
    claim("triaxial, 9 MPa: an inclined band", "Fig 8c", "best plane between 15 and 60 deg of the load", mean(x) > pi / 12 && mean(x) < pi / 3, x, 180 / pi, "deg")
    packs("group=table2;law=softening;test=tension", "localisation_angle", x)
    claim("direct tension: a plane across the load", "Fig 8b", "best plane beyond 75 deg of the load", mean(x) > 5 * pi / 12, x, 180 / pi, "deg")
    packs("group=table2;law=softening;test=brazilian", "localisation_angle", x)
    claim("Brazilian: a plane along the load", "Fig 8d", "best plane within 15 deg of the load", mean(x) < pi / 12, x, 180 / pi, "deg")
    packs("group=table2;law=softening;test=compression", "localisation", x)
    packs("group=table2;law=brittle;test=compression", "localisation", y)
    low = mean(y)
    claim("softening localises the cracks slightly more", "conclusions", "a larger part of the broken area in the best plane than for the brittle law", mean(x) > low, x, 1, "of the area")
}

# Fig 5: E in proportion to E-bar exactly; E grows and nu falls with eta
function figure5(    x, y, z, k, eta, list, n, i, falls, rises, last_e, last_nu) {
    packs("group=elastic;vgcm.eta=0.125;vgcm.e_bar=2x", "E", x)
    packs("group=elastic;vgcm.eta=0.125;vgcm.e_bar=0.5x", "E", y)
    ratio(x, y, z)
    claim("E is in proportion to E-bar", "Fig 5", "4 times for 4 times, within 1 %", size(mean(z) - 4) < 0.04, z, 1, "")
    n = split("0 0.125 0.25 0.5 0.75 1", list, " ")
    rises = falls = 1
    for (i = 1; i <= n; i++) {
        packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=" list[i], "E", x)
        packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=" list[i], "nu", y)
        rises = rises && (i == 1 || mean(x) > last_e)
        falls = falls && (i == 1 || mean(y) < last_nu)
        last_e = mean(x)
        last_nu = mean(y)
    }
    claim("E grows with eta", "Fig 5", "at each step from 0 to 1", rises, x, 1e-9, "GPa at 1")
    claim("nu falls with eta", "Fig 5", "at each step, to 0 +- 0.03 at 1", falls && size(last_nu) < 0.03, y, 1, "at 1")
}

function plot_data(    law, p, i, n, list, x, files) {
    split("softening brittle", law, " ")
    for (i = 1; i <= 2; i++) {
        files = out "/envelope_" law[i] ".dat"
        packs("group=table2;test=compression;law=" law[i], "strength", x)
        point(files, 0, x, 1e-6)
        for (p = 3; p <= 12; p += 3) {
            packs("group=confined;law=" law[i] ";triaxial.pressure=" p " MPa", "sigma_1", x)
            point(files, p, x, 1e-6)
        }
        close(files)
    }
    n = split("0 0.125 0.25 0.5 0.75 1", list, " ")
    for (i = 1; i <= n; i++) {
        packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=" list[i], "E", x)
        point(out "/modulus.dat", list[i], x, 1 / 48.8e9)
        packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=" list[i], "nu", x)
        point(out "/poisson.dat", list[i], x, 1)
    }
}

END {
    pi = atan2(0, -1)
    table2()
    figure5()
    conclusions()
    plot_data()
    write_json(out "/targets.json")
    write_table()
}
