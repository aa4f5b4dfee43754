# SPDX-License-Identifier: GPL-3.0-or-later
# The numbers and claims of the paper on bonded spheropolyhedra beside ours; see cases/paper.awk. What comes of the stress paths is
# in FOLDER/paths.csv (paths.awk), what comes of all breaks together in FOLDER/bursts.json.

function read_paths(    line, name, part, m, k) {
    if ((getline line < (out "/paths.csv")) <= 0)
        return
    m = split(line, name, ",")
    while ((getline line < (out "/paths.csv")) > 0) {
        split(line, part, ",")
        for (k = 2; k <= m; k++)
            path[part[1], name[k]] = part[k]
    }
    close(out "/paths.csv")
    for (line = 1; line <= n_runs; line++)
        for (k = 2; k <= m; k++)
            if ((cell[line, "key"], name[k]) in path)
                cell[line, name[k]] = path[cell[line, "key"], name[k]]
}

# q of eq 31 at p [MPa]
function hoek_brown(p) { return (sqrt(203.3 ^ 2 + 36 * 203.3 * p + 36 * 69.3 ^ 2) - 203.3) / 6 }

# Exponent of a quantity over a factor of 16 in a parameter, sample by sample
function exponent(group, key, quantity, z,    x, y, k) {
    packs("group=" group ";" key "=4x", quantity, x)
    packs("group=" group ";" key "=0.25x", quantity, y)
    split("", z)
    for (k in x)
        if (k in y && x[k] > 0 && y[k] > 0)
            z[k] = log(x[k] / y[k]) / log(16)
}

# largest change of a quantity from that of the paper's set, over all factors of a parameter
function largest_change(place, key, quantity,    i, n, list, m, base, most) {
    n = split("0.25x 0.5x 2x 4x", list, " ")
    base = value(place key "=1x", quantity)
    for (i = 1; i <= n; i++) {
        m = value(place key "=" list[i], quantity)
        if (n_of && size(m / base - 1) > most)
            most = size(m / base - 1)
    }
    return most + 0
}

function one(x, y) {
    split("", x)
    x["all"] = y
}

# the last factor is where the load falls below a fifth of the peak (test.stop_drop)
function disc(    x, y, z, k, kn, kt, bn, bt, eps, place) {
    place = "group=disc;reading=the authors'"
    choices_of("as read|sharp edges|plates without friction|wide plates|bonds by centres|half the target|half the time step|merged springs")
    packs(place, "strain_at_peak", x)
    target("Brazilian disc: strain at the peak", "Fig 7, text", 1.8, 0, "%", 100, x, "group=disc choices;choice=", "strain_at_peak")
    packs(place, "drop_before_peak", x)
    claim("the force grows linearly, like an elastic material's", "Fig 7", "no fall of more than 5 % before the peak", mean(x) < 0.05, x, 100, "%")
    packs(place, "strain_at_end", y)
    packs(place, "strain_at_peak", x)
    ratio(y, x, z)
    for (k in z)
        z[k] -= 1
    claim("then it drops suddenly", "Fig 7", "to a fifth within half of the peak's strain", mean(z) < 0.5, z, 1, "of it")
    packs(place, "localisation_angle", x)
    claim("a vertical crack", "Fig 6b", "best plane within 15 deg of the load", mean(x) < pi / 12, x, 180 / pi, "deg")
    exponent("disc kn", "polyhedra.kn", "strength", z); kn = mean(z)
    exponent("disc kt", "polyhedra.kt", "strength", z); kt = mean(z)
    exponent("disc bn", "polyhedra.bn", "strength", z); bn = mean(z)
    exponent("disc bt", "polyhedra.bt", "strength", z); bt = mean(z)
    claim("sigma_t depends mainly on B_t (and eps_th)", "Fig 8", sprintf("its exponent is the largest of the moduli (others: B_n %.2f, K_n %.2f, K_t %.2f)", bn, kn, kt),
        bt > size(bn) && bt > size(kn) && bt > size(kt), z, 1, "")
    packs("group=disc eps_th;polyhedra.eps_th=2x", "strength", x)
    packs("group=disc eps_th;polyhedra.eps_th=0.25x", "strength", y)
    split("", z)
    for (k in x)
        if (k in y)
            z[k] = log(x[k] / y[k]) / log(8)
    claim("and on eps_th", "Fig 8, inset", "exponent above 0.5", mean(z) > 0.5, z, 1, "")
    exponent("disc kt", "polyhedra.kt", "S", z); kt = mean(z)
    exponent("disc bn", "polyhedra.bn", "S", z); bn = mean(z)
    exponent("disc bt", "polyhedra.bt", "S", x); bt = mean(x)
    exponent("disc kn", "polyhedra.kn", "S", z); kn = mean(z)
    claim("S depends mainly on K_n", "Fig 9", sprintf("its exponent is the largest (others: B_t %.2f, B_n %.2f, K_t %.2f)", bt, bn, kt), kn > bt && kn > bn && kn > kt, z, 1, "")
    claim("with a significant influence of B_t", "Fig 9", "exponent above 0.05", mean(x) > 0.05, x, 1, "")
}

function block(    x, y, z, k, place, c, t) {
    c = ";test.kind=compression"
    t = ";test.kind=tension"
    place = "group=block;reading=the authors'"
    choices_of("as read|twice the strain|ten times the strain|plates with friction|half the target|half the time step|merged springs|held in all directions|area of the facets")
    packs(place c, "E_platen", x)
    target("E_c at the plates", "the authors' code, 10^3 cells", 104.6, 0, "GPa", 1e-9, x, "group=block choices;choice=", "E_platen")
    packs(place c, "E", x)
    target("E_c by the gauge", "the authors' code", 165.7, 0, "GPa", 1e-9, x, "group=block choices;choice=", "E")
    packs(place t, "E_platen", x)
    target("E_t at the plates", "the authors' code", 72, 0, "GPa", 1e-9, x, "group=block choices in tension;choice=", "E_platen")
    packs(place c, "nu", x)
    target("nu", "the authors' code, 0.11 to 0.14", 0.125, 0.0075, "", 1, x)
    one(x, largest_change("group=block kn" t ";", "polyhedra.kn", "E_platen"))
    claim("E_t does not hang on K_n", "Fig 13", "less than 2 % for 0.25 to 4 times", x["all"] < 0.02, x, 100, "%")
    one(x, largest_change("group=block kt" t ";", "polyhedra.kt", "E_platen"))
    claim("nor on K_t", "Fig 13", "less than 2 %", x["all"] < 0.02, x, 100, "%")
    exponent("block bt" t, "polyhedra.bt", "E_platen", z)
    claim("E_t grows with B_t", "Fig 13, eq 27", "exponent above 0.05", mean(z) - 2 * se_of > 0.05, z, 1, "")
    exponent("block bt" c, "polyhedra.bt", "E_platen", y)
    exponent("block kn" c, "polyhedra.kn", "E_platen", z)
    claim("K_n strongly affects E_c", "Fig 12", "exponent above 0.3", mean(z) > 0.3, z, 1, "")
    claim("E_c is also changed by B_t", "Fig 12", "exponent above 0.05", mean(y) > 0.05, y, 1, "")
    one(x, value("group=block kt" c ";polyhedra.kt=4x", "nu") - value("group=block kt" c ";polyhedra.kt=0.25x", "nu"))
    claim("K_t has practically no effect on nu", "Fig 11", "less than 0.02 from 0.25 to 4 times", size(x["all"]) < 0.02, x, 1, "")
    one(x, value("group=block kn" c ";polyhedra.kn=0.25x", "nu") - value("group=block kn" c ";polyhedra.kn=4x", "nu"))
    claim("nu is small for small K_n", "Fig 11", "smaller at 0.25 than at 4 times", x["all"] < 0, x, 1, "")
    one(x, value("group=block bn" c ";polyhedra.bn=4x", "nu") - value("group=block bn" c ";polyhedra.bn=0.25x", "nu"))
    claim("nu falls with B_n", "Fig 11", "smaller at 4 than at 0.25 times", x["all"] < 0, x, 1, "")
    one(x, value("group=block bt" c ";polyhedra.bt=4x", "nu") - value("group=block bt" c ";polyhedra.bt=0.25x", "nu"))
    claim("nu falls with B_t", "Fig 11", "smaller at 4 than at 0.25 times", x["all"] < 0, x, 1, "")
}

# the modulus of a beam whose sides in tension and compression have moduli of their own
function bimodular(c, t) { return 4 * c * t / (sqrt(c) + sqrt(t)) ^ 2 }

function cantilever(    x, y, z, k) {
    choices_of("as read|twice the strain|ten times the strain|plates with friction")
    packs("group=block of the beam;test.kind=compression", "E_platen", x)
    target("E_c of the beam's set, block in compression", "text to Fig 14", 674, 0, "GPa", 1e-9, x, "group=block of the beam, choices;choice=", "E_platen")
    packs("group=block of the beam;test.kind=tension", "E_platen", y)
    for (k in x)
        if (k in y)
            z[k] = bimodular(x[k], y[k])
    target("the bimodular beam of the block's E_c and E_t", "text to Fig 14", 674, 0, "GPa", 1e-9, z)
    choices_of("as read|bonds by centres|merged springs|merged, centres, facet|torsion as in the authors' code")
    packs("group=cantilever", "E_c", x)
    target("E_c of the cantilever by eq 29", "Fig 15", 674, 0, "GPa", 1e-9, x, "group=cantilever choices;choice=", "E_c")
    packs("group=cantilever", "tip", x)
    target("tip of the cantilever", "eq 29", 7.12, 0, "mm", 1e3, x, "group=cantilever choices;choice=", "tip")
}

# Fig 15: how far the beam is from Euler's line of the same modulus, over the tip; the first beam is drawn
function profile(    line, part, of, seed, key, most, tip, i, x) {
    for (i = 1; i <= n_runs; i++)
        if (cell[i, "group"] == "cantilever")
            of[cell[i, "key"]] = cell[i, "specimen.seed"]
    while ((getline line < (out "/profiles.csv")) > 0) {
        split(line, part, ",")
        if (!((key = part[1]) in of))
            continue
        seed = of[key]
        most[seed] = size(part[3] - part[4]) > most[seed] + 0 ? size(part[3] - part[4]) : most[seed]
        tip[seed] = part[3] + 0 > tip[seed] + 0 ? part[3] + 0 : tip[seed]
        if (seed == 1)
            print part[2], part[3] * 1e3, part[4] * 1e3, part[5] * 1e3 >(out "/profile.dat")
    }
    close(out "/profiles.csv")
    for (seed in most)
        x[seed] = most[seed] / tip[seed]
    claim("the beam bends as Euler's", "Fig 15, fair agreement", "within 5 % of the tip everywhere", mean(x) + 2 * se_of < 0.05, x, 100, "% of the tip")
}

# what rules the breaking and the friction of the grains out as causes
function least_of_scan(    i, n, list, p, x, k, least) {
    for (p = 110; p <= 190; p += 80) {
        strength_at("group=scan;p=" p, x)
        least[p] = 1e12
        for (i = 1; i <= n_runs; i++)
            if (is_at(i, "group=scan;p=" p) && cell[i, "q_residual"] + 0 > 0 && cell[i, "q_residual"] + 0 < least[p])
                least[p] = cell[i, "q_residual"] + 0
    }
    return sprintf("eps_th of 0.0005 to 0.02 with mu of 0 to 0.3 (the least q of the scan is %.0f MPa at 110 MPa, %.0f at 190)", least[110] / 1e6, least[190] / 1e6)
}

function paths(    x, y, z, k, i, n, p, list, bonded, unbonded, low, high, slope, free) {
    choices_of("as read|merged springs|strict springs|bonds by centres|torsion as in the authors' code|a tenth of eps_th|no friction")
    n = split("110 130 150 170 190 210", list, " ")
    for (i = 1; i <= n; i++) {
        p = list[i]
        strength_at("group=envelope;p=" p, x)
        target("peak q at p = " p " MPa", "Fig 22, eq 31", sprintf("%.4g", hoek_brown(p)), 0, "MPa", 1e-6, x, p == 110 ? "group=choices;choice=" : "", "q_at_peak")
        if (p != 110)
            explain("", least_of_scan())
    }
    read_fit(out "/hoek_brown/envelope_fits.csv")
    for (p = 110; p <= 190; p += 80) {
        strength_at("group=scan;polyhedra.mu=0;polyhedra.eps_th=0.0005;p=" p, x)
        target("q at p = " p " MPa with mu = 0, eps_th = 0.0005, the nearest of the scan", "Fig 22", sprintf("%.4g", hoek_brown(p)), 0, "MPa", 1e-6, x)
    }
    packs("group=envelope;p=110", "q_at_peak", x)
    packs("group=envelope;p=110", "q_residual", y)
    ratio(x, y, z)
    low = mean(z)
    claim("low pressure: a peak, then a residual state", "Fig 17", "peak at least 10 % above it at 110 MPa", low > 1.1, z, 1, "")
    packs("group=envelope;p=210", "q_at_peak", x)
    packs("group=envelope;p=210", "q_residual", y)
    ratio(x, y, z)
    claim("the peak fades with the pressure", "Fig 17", "peak over residual is smaller at 210 than at 110 MPa", mean(z) + 2 * se_of < low, z, 1, "at 210 MPa")
    packs("group=envelope;p=110", "q_residual", x)
    packs("group=unbonded;p=110", "q_residual", y)
    ratio(x, y, z)
    claim("the residual state is frictional alone", "Fig 17", "q with and without bonds within 5 %", size(mean(z) - 1) < 0.05, z, 1, "")
    packs("group=envelope;p=210", "q_at_peak", x)
    packs("group=envelope;p=150", "q_at_peak", y)
    split("", z)
    for (k in x)
        if (k in y)
            z[k] = (x[k] - y[k]) / 60e6
    bonded = mean(z)
    high = se_of
    packs("group=unbonded;p=210", "q_at_peak", x)
    packs("group=unbonded;p=150", "q_at_peak", y)
    split("", slope)
    for (k in x)
        if (k in y)
            slope[k] = (x[k] - y[k]) / 60e6
    free = mean(slope)
    claim("above 140 MPa the envelope has the cohesionless slope", "Fig 21", sprintf("dq/dp of 150 to 210 MPa as without bonds (%.2f) within 10 %%", free), size(bonded / (free ? free : 1) - 1) < 0.1, z, 1, "")
    packs("group=thresholds;polyhedra.eps_th=0.02", "q_at_peak", x)
    packs("group=thresholds;polyhedra.eps_th=0.01", "q_at_peak", y)
    ratio(x, y, z)
    claim("a larger eps_th gives a higher peak", "Fig 18", "0.02 over 0.01, by more than 2 standard errors", mean(z) - 2 * se_of > 1, z, 1, "")
    packs("group=frictions;polyhedra.mu=0.3", "q_at_peak", x)
    packs("group=frictions;polyhedra.mu=0.1", "q_at_peak", y)
    ratio(x, y, z)
    claim("so does a larger mu", "Fig 19", "0.3 over 0.1, by more than 2 standard errors", mean(z) - 2 * se_of > 1, z, 1, "")
    packs("group=torsion;polyhedra.torsion=off", "q_at_peak", x)
    packs("group=torsion;polyhedra.torsion=on", "q_at_peak", y)
    ratio(x, y, z)
    claim("torsion is not needed in a Voronoi pack", "section 2.2", "peak without over with it within 5 %", size(mean(z) - 1) < 0.05, z, 1, "")
    packs("group=envelope;p=110", "strain_of_dilation", x)
    packs("group=envelope;p=110", "strain_at_peak", y)
    ratio(x, y, z)
    claim("bonded: it dilates from the peak on", "Fig 20", "smallest volume within 20 % of the strain at the peak", size(mean(z) - 1) < 0.2, z, 1, "of it")
    packs("group=unbonded;p=110", "strain_of_dilation", x)
    packs("group=unbonded;p=110", "strain_at_peak", y)
    ratio(x, y, z)
    claim("without bonds it dilates early", "Fig 20", "smallest volume before half of the strain at the peak", mean(z) < 0.5, z, 1, "of it")
    packs("group=envelope;p=110", "dilation", x)
    packs("group=unbonded;p=110", "dilation", y)
    ratio(x, y, z)
    claim("after the peak both dilate alike", "Fig 20", "d eps_v / d eps_d of the second half within 25 %", size(mean(z) - 1) < 0.25, z, 1, "")
}

# Hoek and Brown's fit by `breccia envelope`, through the points of all samples
function read_fit(file,    line, part, best, error, r2, x) {
    while ((getline line < file) > 0) {
        split(line, part, ",")
        if (part[1] == "Hoek-Brown") {
            best[part[2]] = part[4]
            error[part[2]] = part[5]
            r2 = part[8]
        }
    }
    close(file)
    fitted("A of Hoek and Brown", "Fig 22", 203.3, 10.1, best["A"], error["A"], "MPa")
    fitted("B of Hoek and Brown", "Fig 22", 69.3, 2.6, best["B"], error["B"], "MPa")
    one(x, r2)
    claim("their curve fits", "Fig 22, R2 = 0.9944", "R2 above 0.98", r2 > 0.98, x, 1, "")
    strength_at("group=low pressure", x)
    claim("a strength at p = 0", "Fig 21", "q at 1 MPa above 10 MPa", mean(x) > 1e7, x, 1e-6, "MPa")
}

# a number of ours that comes with its own error
function fitted(name, figure, paper, paper_se, ours, error, unit,    x) {
    one(x, ours)
    target(name, figure, paper, paper_se, unit, 1, x)
    e_se[n_entries] = error
    e_n[n_entries] = packs("group=envelope;p=110", "sigma_1", x)
    e_error[n_entries] = 2 * sqrt(error ^ 2 + paper_se ^ 2)
    e_agrees[n_entries] = e_n[n_entries] >= 6 && error < 0.03 * size(ours) && (size(ours - paper) <= 0.05 * size(paper) || size(ours - paper) <= e_error[n_entries])
}

# The exponents of all breaks of the envelope's runs: bursts.csv of `breccia bursts`
function exponents(    line, part, of, error, p, size_of) {
    while ((getline line < (out "/bursts/bursts.csv")) > 0) {
        split(line, part, ",")
        of[part[1], part[2]] = part[3]
        error[part[1], part[2]] = part[4]
        p[part[1], part[2]] = part[8]
    }
    close(out "/bursts/bursts.csv")
    split("0.1 0.3 1", part, " ")
    for (line = 1; line <= 3; line++) {
        fitted("exponent of breaks in spans of " part[line] " % of the strain", "Fig 24", -1.51, 0.03, of["histogram", part[line] / 100],
            error["histogram", part[line] / 100], "")
        explain(line < 3 ? sprintf("spans of 1 %%: %.2f", of["histogram", 0.01]) : "", "")
    }
    split("10 30 100", part, " ")
    for (line = 1; line <= 3; line++) {
        one(size_of, of["avalanches", part[line]])
        claim("avalanches with gaps of " part[line] " steps are a power law", "section 4.6", sprintf("p above 0.1 (it is %.2f)", p["avalanches", part[line]]),
            p["avalanches", part[line]] > 0.1, size_of, 1, "its exponent")
        e_se[n_entries] = error["avalanches", part[line]]
    }
}

function bursts(    x, y, z, k) {
    exponents()
    packs("group=envelope;p=110", "breaks_in_last_quarter", x)
    claim("in the residual state no more bonds break", "Fig 23", "less than 5 % of the breaks in the last quarter of the strain", mean(x) < 0.05, x, 100, "%")
    packs("group=envelope;p=110", "strain_of_fastest_breaking", x)
    claim("the peak comes with the second burst", "Fig 23", "bonds break fastest between 0.9 and 1.5 times the strain of the peak", mean(x) > 0.9 && mean(x) < 1.5, x, 1, "of it")
}

# A quantity over a parameter, relative to that of the paper's set: FOLDER/QUANTITY_PARAMETER.dat
function scan(figure, place, key, quantity,    n, i, list, x, base) {
    n = split("0.25x 0.5x 1x 2x 4x", list, " ")
    base = value(place key "=1x", quantity)
    if (!n_of)
        return
    for (i = 1; i <= n; i++) {
        packs(place key "=" list[i], quantity, x)
        point(out "/" figure "_" substr(key, 11) ".dat", list[i] + 0, x, 1 / base)
    }
    close(out "/" figure "_" substr(key, 11) ".dat")
}

# q that a pack bears at p: at its peak, or, where it is still rising at the end, there
function strength_at(place, x,    y, k) {
    packs(place, "q_residual", x)
    packs(place, "q_at_peak", y)
    for (k in y)
        x[k] = y[k]
}

function envelope_data(name, group,    n, i, list, x, file) {
    n = split("30 60 85 110 130 150 170 190 210", list, " ")
    file = out "/q_" name ".dat"
    for (i = 1; i <= n; i++) {
        strength_at("group=" group ";p=" list[i], x)
        point(file, list[i], x, 1e-6)
    }
    close(file)
}

function curve_data(    line, part, names, of, name, i) {
    for (i = 1; i <= n_runs; i++) {
        name = cell[i, "group"]
        if (cell[i, "specimen.seed"] == 1 && (name == "envelope" || name == "unbonded"))
            of[cell[i, "key"]] = of[cell[i, "key"]] " " name "_" cell[i, "p"]
    }
    while ((getline line < (out "/curves.csv")) > 0) {
        split(line, part, ",")
        for (i = split(of[part[1]], names, " "); i >= 1; i--)
            print part[3], part[4] * 1e-6, part[5], part[2], part[6] >(out "/path_" names[i] ".dat")
    }
}

function plot_data(    n, i, list) {
    n = split("kn kt bn bt", list, " ")
    for (i = 1; i <= n; i++) {
        scan("strength", "group=disc " list[i] ";", "polyhedra." list[i], "strength")
        scan("slope", "group=disc " list[i] ";", "polyhedra." list[i], "S")
        scan("nu", "group=block " list[i] ";test.kind=compression;", "polyhedra." list[i], "nu")
        scan("e_c", "group=block " list[i] ";test.kind=compression;", "polyhedra." list[i], "E_platen")
        scan("e_t", "group=block " list[i] ";test.kind=tension;", "polyhedra." list[i], "E_platen")
    }
    scan("strength", "group=disc eps_th;", "polyhedra.eps_th", "strength")
    envelope_data("envelope", "envelope")
    envelope_data("unbonded", "unbonded")
    envelope_data("scan", "scan;polyhedra.mu=0;polyhedra.eps_th=0.0005")
    envelope_data("rival", "rival envelope")
    curve_data()
}

function precision_row(name, place, base, quantity, scale, unit,    x, m) {
    packs(place base, quantity, x)
    m = mean(x) * scale
    printf "| %s | %.4g +- %.2g %s (%d) | %s | %s |\n", name, m, se_of * scale, unit, n_of, change_cell(place, base, "half the target", quantity, 2),
        change_cell(place, base, "half the time step", quantity, 1)
}

function write_precision() {
    print "\n### Precision\n"
    print "| value | mean | half the loading target | half the time step |"
    print "|---|---|---|---|"
    precision_row("peak q at 110 MPa", "group=precision;numerics=", "as run", "q_at_peak", 1e-6, "MPa")
    precision_row("residual q at 110 MPa", "group=precision;numerics=", "as run", "q_residual", 1e-6, "MPa")
    precision_row("strength of the disc", "group=disc choices;choice=", "as read", "strength", 1e-6, "MPa")
    precision_row("its strain at the peak", "group=disc choices;choice=", "as read", "strain_at_peak", 100, "%")
    precision_row("E_c at the plates", "group=block choices;choice=", "as read", "E_platen", 1e-9, "GPa")
    precision_row("E_t at the plates", "group=block choices in tension;choice=", "as read", "E_platen", 1e-9, "GPa")
    write_changes()
}

function size_cell(test, quantity, n, scale,    x, m) {
    packs("group=block size;size=" n ";test.kind=" test, quantity, x)
    m = mean(x) * scale
    return sprintf("%.4g +- %.2g", m, se_of * scale)
}

# The layer of cells that the walls cut is a smaller part of a larger block
function write_size(    list, n, i, line) {
    n = split("5 7 10 14", list, " ")
    print "\n### Size of the block\n"
    print "| cells a side | 5 | 7 | 10 | 14 |"
    print "|---|---|---|---|---|"
    for (i = 1; i <= n; i++) {
        line[1] = line[1] " | " size_cell("compression", "E_platen", list[i], 1e-9)
        line[2] = line[2] " | " size_cell("compression", "E", list[i], 1e-9)
        line[3] = line[3] " | " size_cell("compression", "nu", list[i], 1)
        line[4] = line[4] " | " size_cell("tension", "E_platen", list[i], 1e-9)
    }
    print "| E_c at the plates [GPa]" line[1] " |\n| E_c by the gauge [GPa]" line[2] " |\n| nu" line[3] " |\n| E_t at the plates [GPa]" line[4] " |"
}

function rival_cell(group, p,    x, m) {
    strength_at("group=" group ";p=" p, x)
    m = mean(x) * 1e-6
    return n_of ? sprintf("%.4g +- %.2g (%d)", m, se_of * 1e-6, n_of) : ""
}

function write_rival(    list, n, i) {
    n = split("30 60 85 110 130 150 170 190 210", list, " ")
    print "\n### q at the peak [MPa], of both models\n"
    print "| p [MPa] | the paper's fit | Table 1 as printed | the same, `merged`, `centres`, `facet` | without bonds | VGCM-3D, its granite set |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= n; i++)
        printf "| %d | %.0f | %s | %s | %s | %s |\n", list[i], hoek_brown(list[i]), rival_cell("envelope", list[i]), rival_cell("envelope, own reading", list[i]),
            rival_cell("unbonded", list[i]), rival_cell("rival envelope", list[i])
}

END {
    pi = atan2(0, -1)
    read_paths()
    disc()
    block()
    cantilever()
    profile()
    paths()
    bursts()
    plot_data()
    write_json(out "/targets.json")
    write_table()
    write_rival()
    write_precision()
    write_size()
}
