# SPDX-License-Identifier: GPL-3.0-or-later
# The numbers and claims of the paper on VGCM-3D beside ours; see cases/paper.awk.

# c and phi (eq 31's line through sigma_1 at all pressures), pack by pack; the places of the runs without and with pressure
function mohr_coulomb(free, confined, cohesion, angle,    s, y, k, p, n, sx, sy, sxx, sxy, m, slope) {
    split("", cohesion)
    split("", angle)
    split("", s)
    packs(free, "strength", s)
    for (k in s) {
        n = 1
        sx = sxx = sxy = 0
        sy = s[k]
        for (p = 3; p <= 12; p += 3)
            if (packs(confined ";triaxial.pressure=" p " MPa;specimen.seed=" k, "sigma_1", y)) {
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

# Entries of c, phi and direct / Brazilian, with what each choice makes of them
function derived_of_table2(law, choices, paper_of,    k, x, y, z, m, ratios, unconfined, cohesions, angles) {
    split("", unconfined)
    split("", ratios)
    split("", cohesions)
    split("", angles)
    for (k = 1; k <= n_choices; k++) {
        packs(choices "tension;choice=" choice_name[k], "strength", x)
        packs(choices "brazilian;choice=" choice_name[k], "strength", y)
        ratio(x, y, z)
        m = mean(z)
        if (n_of)
            ratios[choice_name[k]] = m
        packs(choices "compression;choice=" choice_name[k], "strength", x)
        ratio(x, y, z)
        m = mean(z)
        if (n_of)
            unconfined[choice_name[k]] = m
        mohr_coulomb(choices "compression;choice=" choice_name[k], "group=confined choices;law=" law ";choice=" choice_name[k], y, z)
        m = mean(y)
        if (!n_of)
            continue
        cohesions[choice_name[k]] = m
        angles[choice_name[k]] = mean(z)
    }
    packs("group=table2;test=tension;law=" law, "strength", x)
    packs("group=table2;test=brazilian;law=" law, "strength", y)
    ratio(x, y, z)
    target("direct / Brazilian, " law, "Table 2", sprintf("%.3f", paper_of["direct"] / paper_of["indirect"]), 0, "", 1, z)
    weigh_last(ratios, 1)
    packs("group=table2;test=compression;law=" law, "strength", x)
    ratio(x, y, z)
    target("unconfined / Brazilian, " law, "Table 2", sprintf("%.2f", paper_of["ucs"] / paper_of["indirect"]), 0, "", 1, z)
    weigh_last(unconfined, 1)
    mohr_coulomb("group=table2;test=compression;law=" law, "group=confined;law=" law, y, z)
    target("cohesion, " law, "Table 2", paper_of["c"], 0, "MPa", 1e-6, y)
    weigh_last(cohesions, 1e-6)
    target("friction angle, " law, "Table 2", paper_of["phi"], 0, "deg", 1, z)
    weigh_last(angles, 1)
}

function law_of_table2(law, paper_of,    x, p, choices) {
    choices = "law=" law ";test="
    packs("group=table2;test=compression;law=" law, "E", x)
    target("E, " law, "Table 2", 25.8, 0, "GPa", 1e-9, x, choices "compression;choice=", "E")
    packs("group=table2;test=compression;law=" law, "nu", x)
    target("nu, " law, "Table 2", 0.23, 0, "", 1, x, choices "compression;choice=", "nu")
    packs("group=table2;test=compression;law=" law, "strength", x)
    target("unconfined strength, " law, "Table 2", paper_of["ucs"], 0, "MPa", 1e-6, x, choices "compression;choice=", "strength")
    packs("group=table2;test=tension;law=" law, "strength", x)
    target("direct tension, " law, "Table 2", paper_of["direct"], 0, "MPa", 1e-6, x, choices "tension;choice=", "strength")
    packs("group=table2;test=brazilian;law=" law, "strength", x)
    target("Brazilian strength, " law, "Table 2", paper_of["indirect"], 0, "MPa", 1e-6, x, choices "brazilian;choice=", "strength")
    derived_of_table2(law, choices, paper_of)
    for (p = 3; p <= 12; p += 3) {
        packs("group=confined;law=" law ";triaxial.pressure=" p " MPa", "sigma_1", x)
        target("sigma_1 at " p " MPa, " law, "Fig 6, from c and phi", paper_of[p], 0, "MPa", 1e-6, x, "law=" law ";triaxial.pressure=" p " MPa;choice=", "sigma_1")
    }
}

# "name value name value": what the paper gives; 3 to 12 are sigma_1 [MPa] at that pressure
function read_paper(list, paper_of,    word, n, i) {
    n = split(list, word, " ")
    for (i = 1; i < n; i += 2)
        paper_of[word[i]] = word[i + 1]
}

# The packs themselves; the paper's solid fraction is that of its spheres in its cylinder, its distance that by which Table
# 1's energies are strength^2 d / (2 E-bar), 9.5 times in the set that softens
function specimens(    x) {
    packs("group=specimens;shape=core", "n_grains", x)
    target("spheres of the core", "3.1", 7988, 0, "", 1, x)
    put_in()
    packs("group=specimens;shape=disc", "n_grains", x)
    target("spheres of the disc", "3.1", 1997, 0, "", 1, x)
    put_in()
    packs("group=specimens;shape=core", "diameter", x)
    target("mean diameter", "3.1", 5, 0, "mm", 1e3, x)
    put_in()
    packs("group=specimens;shape=core", "solid_fraction", x)
    target("solid fraction, core", "3.1, from the number of spheres", 0.676, 0, "", 1, x)
    put_in()
    packs("group=specimens;shape=core", "distance", x)
    target("mean distance of centres in contact, core", "Table 1, from its energies", 5.102, 0, "mm", 1e3, x)
    put_in()
    packs("group=specimens;shape=disc", "distance", x)
    target("mean distance of centres in contact, disc", "Table 1, from its energies", 5.102, 0, "mm", 1e3, x)
}

function table2(    paper_of) {
    choices_of("as read|energies of the print|kink at a third|linear softening|damage by strength|gap of 0.7 mm|gap of 1 mm|all facets|large facets|exact points|one point|looser packing|damping of all motion|damping along the velocity|half the target|a quarter of the target|damping of all motion by 0.3|rough platens|disc of 64 sides")
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

function conclusions(    x, y, z, k, direct, indirect, low, high, list) {
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
    claim("under pressure it still is brittle", "conclusions", "at 12 MPa half of the load is lost within half of the peak's strain", mean(y) < 0.5, y, 1, "of it")
    brittle_in_tension()
    inflections()

    packs("group=table2;law=softening;test=compression", "crack_angle", x)
    claim("compression: vertical cracks", "Fig 8a", "mean angle to the load below 30 deg (32.7 at random)", mean(x) < pi / 6, x, 180 / pi, "deg")
    packs("group=confined;law=softening;triaxial.pressure=9 MPa", "localisation_angle", x)
    claim("triaxial, 9 MPa: an inclined band", "Fig 8c", "best plane between 15 and 60 deg of the load", mean(x) > pi / 12 && mean(x) < pi / 3, x, 180 / pi, "deg")
    explain("counting slip instead of broken area, as the next line does: cracks are all over the core, and its longest plane holds most", "")
    packs("group=band", "slip", y)
    packs("group=band", "volume", z)
    low = mean(y)
    high = mean(z)
    packs("group=band", "angle", x)
    claim("the same by slip", "Fig 8c", sprintf("between 15 and 60 deg, with more than twice its share of the slip (%.2f in %.2f of the volume)", low, high),
        mean(x) > pi / 12 && mean(x) < pi / 3 && low > 2 * high, x, 180 / pi, "deg")
    packs("group=table2;law=softening;test=tension", "localisation_angle", x)
    claim("direct tension: a plane across the load", "Fig 8b", "best plane beyond 75 deg of the load", mean(x) > 5 * pi / 12, x, 180 / pi, "deg")
    packs("group=table2;law=softening;test=brazilian", "localisation_angle", x)
    claim("Brazilian: a plane along the load", "Fig 8d", "best plane within 15 deg of the load", mean(x) < pi / 12, x, 180 / pi, "deg")
    split("tension brazilian compression", list, " ")
    for (k = 1; k <= 3; k++) {
        packs("group=table2;law=softening;test=" list[k], "localisation", x)
        packs("group=table2;law=brittle;test=" list[k], "localisation", y)
        low = mean(y)
        claim("softening localises the cracks slightly more, " list[k], "conclusions", sprintf("a larger part of the broken area in the best plane than for the brittle law (%.3f)", low), mean(x) > low, x, 1, "of the area")
    }
    explain("", "the measure: cracks all over the core have 0.2 of their area in their best plane, and these have no more under either law")
}

# Of the load 70 % has to go, as the runs in tension end there.
function brittle_in_tension(    z, linear, low) {
    ductility("law=softening;test=tension;choice=linear softening", linear)
    low = mean(linear)
    ductility("group=table2;law=softening;test=tension", z)
    claim("softening stays brittle in tension", "conclusions", "70 % of the load is lost within half of the peak's strain", mean(z) < 0.5, z, 1, "of it")
    explain(sprintf("linear softening (%.2f of it)", low), "")
}

# The tangent modulus at the first inflection of the first pack's curve, over that of its foot: in steps of 0.04 % of
# strain, the first value below 0.9 that the next one exceeds
function inflection(test, law,    file, line, field, n, e, s, peak, i, from, foot, at, tangent, last) {
    file = out "/curve_" test "_" law ".csv"
    while ((getline line < file) > 0)
        if (split(line, field, ",") == 2 && field[1] + 0 > 0) {
            e[++n] = field[1] + 0
            s[n] = field[2] + 0
            if (s[n] > s[peak])
                peak = n
        }
    close(file)
    for (i = 1; i <= peak && s[i] < 0.15 * s[peak]; i++)
        if (s[i] < 0.05 * s[peak])
            from = i
    at = from + 1
    foot = (s[i - 1] - s[at]) / (e[i - 1] - e[at])
    for (i = at; i <= peak; i++)
        if (e[i] >= e[at] + 4e-4) {
            tangent = (s[i] - s[at]) / (e[i] - e[at]) / foot
            if (last && last < 0.9 && tangent > last)
                return last
            last = tangent
            at = i
        }
    return 1
}

# Fig 7: an inflection is a change of the slope, not of the load; both are here.
function inflections(    x, y, high, z, brittle, softening, i, test) {
    packs("group=table2;law=brittle;test=compression", "drop_before_peak", x)
    packs("group=table2;law=softening;test=compression", "drop_before_peak", y)
    high = mean(y)
    claim("the brittle law's curve has an inflection below its peak: of the load", "Fig 7", "the load falls by more than 2 % before it, and the softening law's by less", mean(x) > 0.02 && high < mean(x), x, 100, "%")
    explain("the inflection being one of the slope, as the next line has it", "")
    split("compression triaxial_3 triaxial_9 triaxial_12", test, " ")
    for (i = 1; i <= 4; i++) {
        brittle[i] = inflection(test[i], "brittle")
        softening[i] = inflection(test[i], "softening")
    }
    z[1] = brittle[1]
    claim("the same: of the slope", "Fig 7", "the tangent modulus falls below half of E before the peak, and rises again", z[1] < 0.5, z, 1, "of E")
    z[1] = brittle[2]
    claim("it is more pronounced at 0 and 3 MPa", "Fig 7", sprintf("the slope falls further at 0 (%.2f) and 3 MPa than at 9 (%.2f) and 12 (%.2f)", brittle[1], brittle[3], brittle[4]),
        brittle[1] < brittle[3] && brittle[1] < brittle[4] && brittle[2] < brittle[3] && brittle[2] < brittle[4], z, 1, "of E at 3 MPa")
    z[1] = softening[1]
    claim("softening has less of it", "Fig 7", sprintf("its slope falls less at 0 (brittle: %.2f) and at 3 MPa (%.2f, brittle: %.2f)", brittle[1], softening[2], brittle[2]),
        softening[1] > brittle[1] && softening[2] > brittle[2], z, 1, "of E at 0")
}

# Fig 5: E in proportion to E-bar exactly; E grows and nu falls with eta
function figure5(    x, y, z, foot, closed, list, n, i, falls, rises, last_e, last_nu, low, high) {
    packs("group=elastic;vgcm.eta=0.125;vgcm.e_bar=2x", "E", x)
    packs("group=elastic;vgcm.eta=0.125;vgcm.e_bar=0.5x", "E", y)
    ratio(x, y, z)
    packs("group=foot of the curve;vgcm.e_bar=2x", "E", x)
    packs("group=foot of the curve;vgcm.e_bar=0.5x", "E", y)
    ratio(x, y, foot)
    closed = (mean(foot) - mean(z)) / (4 - mean(z))
    claim("E is in proportion to E-bar", "Fig 5", "4 times for 4 times, within 1 %", size(mean(z) - 4) < 0.04, z, 1, "")
    explain(sprintf("moduli of the foot of the curve, where no point softens yet (%+.0f %% of the gap)", 100 * closed), "")
    claim("the same, at the foot of the curve", "Fig 5", "4 times for 4 times, within 1 %", size(mean(foot) - 4) < 0.04, foot, 1, "")
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

    low = value("group=elastic;vgcm.e_bar=0.5x;vgcm.eta=1", "E") - value("group=elastic;vgcm.e_bar=0.5x;vgcm.eta=0", "E")
    packs("group=elastic;vgcm.e_bar=2x;vgcm.eta=1", "E", x)
    packs("group=elastic;vgcm.e_bar=2x;vgcm.eta=0", "E", y)
    for (i in x)
        x[i] -= y[i]
    claim("eta counts more for E where E-bar is higher", "Fig 5, text", sprintf("E grows by more from eta 0 to 1 at twice E-bar than at half of it (%.3g GPa)", low * 1e-9), mean(x) > low, x, 1e-9, "GPa")
    high = size(value("group=foot of the curve;vgcm.e_bar=2x", "nu") - value("group=foot of the curve;vgcm.e_bar=0.5x", "nu"))
    packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=0", "nu", x)
    packs("group=elastic;vgcm.e_bar=1x;vgcm.eta=1", "nu", y)
    for (i in x)
        x[i] -= y[i]
    claim("nu hangs mainly on eta", "Fig 5, text", sprintf("its span over eta is more than 5 times that over E-bar at the foot (%.2g)", high), mean(x) > 5 * high, x, 1, "over eta")
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

# --- precision and size ---------------------------------------------------------------------------

function write_precision(    law, test, i, j, place, x, m) {
    split("softening brittle", law, " ")
    split("compression tension brazilian", test, " ")
    print "\n### Precision\n"
    print "| strength | mean | half the loading target | half the time step |"
    print "|---|---|---|---|"
    for (i = 1; i <= 2; i++)
        for (j = 1; j <= 3; j++) {
            place = "group=precision;law=" law[i] ";test=" test[j] ";numerics="
            packs(place "as run", "strength", x)
            m = mean(x) * 1e-6
            printf "| %s, %s | %.4g +- %.2g MPa (%d) | %s | %s |\n", test[j], law[i], m, se_of * 1e-6, n_of,
                change_cell(place, "as run", "half the target", "strength", 2), change_cell(place, "as run", "half the time step", "strength", 1)
        }
    write_changes()
}

function size_cell(place, grains,    x, m) {
    packs(place grains, "strength", x)
    m = mean(x) * 1e-6
    return n_of ? sprintf("%.4g +- %.2g MPa", m, se_of * 1e-6) : "not run"
}

function write_size(    law, test, i, j, place) {
    split("softening brittle", law, " ")
    split("compression tension", test, " ")
    print "\n### Size, with grains of 4 to 6 mm\n"
    print "| strength | about 500 grains, 32 x 64 mm | 2000, 50 x 101 mm | 7988, 80 x 160 mm |"
    print "|---|---|---|---|"
    for (i = 1; i <= 2; i++)
        for (j = 1; j <= 2; j++) {
            place = "group=size;law=" law[i] ";test=" test[j] ";grains="
            printf "| %s, %s | %s | %s | %s |\n", test[j], law[i], size_cell(place, 500), size_cell(place, 2000), size_cell(place, 8000)
        }
}

function pack_cell(shape, quantity, scale, format,    x, m) {
    packs("group=specimens;shape=" shape, quantity, x)
    m = mean(x) * scale
    return sprintf(format " +- %.2g", m, se_of * scale)
}

function write_packs(    shape, i) {
    split("core disc", shape, " ")
    print "\n### The packs\n"
    print "| 8 packs | spheres | mean diameter | solid fraction | contacts between spheres | a sphere | mean distance of centres |"
    print "|---|---|---|---|---|---|---|"
    for (i = 1; i <= 2; i++)
        printf "| %s | %d | %s mm | %s | %s | %s | %s mm |\n", shape[i], value("group=specimens;shape=" shape[i], "n_grains"),
            pack_cell(shape[i], "diameter", 1e3, "%.4g"), pack_cell(shape[i], "solid_fraction", 1, "%.4f"), pack_cell(shape[i], "n_contacts", 1, "%.0f"),
            pack_cell(shape[i], "contacts_per_grain", 1, "%.3g"), pack_cell(shape[i], "distance", 1e3, "%.4g")
}

END {
    pi = atan2(0, -1)
    specimens()
    table2()
    figure5()
    conclusions()
    plot_data()
    write_json(out "/targets.json")
    write_table()
    write_precision()
    write_size()
    write_packs()
}
