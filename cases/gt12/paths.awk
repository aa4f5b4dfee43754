# SPDX-License-Identifier: GPL-3.0-or-later
# What the table of gt12 needs of the stress paths themselves and runs.csv does not have: dilation, when bonds break, and
# curves to draw. A line a run by its key, so that runs whose folders are gone keep theirs; docs/make-paper says
#     awk -f cases/paper.awk -f cases/gt12/paths.awk -v out=FOLDER runs.csv
# which renews FOLDER/{paths,curves,profiles}.csv from FOLDER/runs/KEY.

function read_old(file, lines, head,    line, part) {
    while ((getline line < file) > 0)
        if (line != head && split(line, part, ","))
            lines[part[1]] = lines[part[1]] line "\n"
    close(file)
}

# curve.csv of a run into c[row, name]; rows of the last stage alone
function read_curve(key, c,    file, line, n, m, name, part, k) {
    file = out "/runs/" key "/curve.csv"
    split("", c)
    n = 0
    if ((getline line < file) <= 0)
        return 0
    m = split_csv(line, name)
    for (k = 1; k <= m; k++)
        sub(/ \[.*/, "", name[k])
    while ((getline line < file) > 0) {
        split_csv(line, part)
        n++
        for (k = 1; k <= m; k++)
            c[n, name[k]] = part[k] + 0
    }
    close(file)
    return n
}

# Strain along z since the shearing began [1] at which the volume is smallest, the slope -d eps_v / d eps_d over the second half of
# the strain, and parts of all breaks: before the peak, from it to twice its strain, in the last quarter of the strain; strain of
# the fastest breaking (of 1/50 of the path), over that of the peak.
function path_of(c, n, peak,    i, first, end, most, volume_at, half, sx, sy, sxx, sxy, m, total, before, soon, late, bin, count, k, best) {
    for (i = 1; c[i, "stage"] != c[n, "stage"]; i++)
        continue
    first = i
    for (i = n; i >= first; i--)
        c[i, "strain"] -= c[first, "strain"]
    end = c[n, "strain"]
    most = -1e9
    for (; i <= n; i++) {
        if (c[i, "eps_v"] > most) {
            most = c[i, "eps_v"]
            volume_at = c[i, "strain"]
        }
        if (c[i, "strain"] > end / 2) {
            m++
            sx += c[i, "eps_d"]
            sy -= c[i, "eps_v"]
            sxx += c[i, "eps_d"] ^ 2
            sxy -= c[i, "eps_d"] * c[i, "eps_v"]
        }
    }
    total = c[n, "broken"] - c[first, "broken"]
    for (i = first; i < n; i++) {
        k = c[i + 1, "broken"] - c[i, "broken"]
        before += c[i, "strain"] < peak ? k : 0
        soon += c[i, "strain"] >= peak && c[i, "strain"] < 2 * peak ? k : 0
        late += c[i, "strain"] > 0.75 * end ? k : 0
        count[int(50 * c[i, "strain"] / end)] += k
    }
    best = 0
    for (k = 0; k < 50; k++)
        if (count[k] > count[best])
            best = k
    if (total == 0)
        total = before = soon = late = 0
    return sprintf("%.6g,%.6g,%d,%.4g,%.4g,%.4g,%.4g", volume_at, m * sxx - sx * sx ? (m * sxy - sx * sy) / (m * sxx - sx * sx) : 0, total,
        total ? before / total : 0, total ? soon / total : 0, total ? late / total : 0, (best + 0.5) / 50 * end / peak)
}

# the deflection of a beam along it, beside Euler's and Timoshenko's of the same modulus
function profile_of(key,    file, line, text, part) {
    file = out "/runs/" key "/profile.csv"
    getline line < file
    while ((getline line < file) > 0) {
        split(line, part, ",")
        text = text sprintf("%s,%.5g,%.5g,%.5g,%.5g\n", key, part[1], part[2], part[3], part[4])
    }
    close(file)
    return text
}

# some 150 points of a path, the last stage alone
function curve_of(key, c, n,    i, at, step, text) {
    step = c[n, "strain"] / 150 # since the stage began: path_of
    at = 0
    for (i = 1; i <= n; i++)
        if (c[i, "stage"] == c[n, "stage"] && c[i, "strain"] >= at) {
            text = text sprintf("%s,%.5g,%.5g,%.5g,%.5g,%d\n", key, c[i, "strain"], c[i, "eps_d"], c[i, "q"], c[i, "eps_v"], c[i, "broken"])
            at = c[i, "strain"] + step
        }
    return text
}

function write_all(file, head, lines,    key, order, n, i, k, swap) {
    print head >file
    n = 0
    for (key in lines)
        order[++n] = key
    for (i = 2; i <= n; i++)
        for (k = i; k > 1 && order[k] < order[k - 1]; k--) {
            swap = order[k]
            order[k] = order[k - 1]
            order[k - 1] = swap
        }
    for (i = 1; i <= n; i++)
        printf "%s", lines[order[i]] >file
    close(file)
}

END {
    path_head = "key,strain_of_dilation,dilation,n_breaks,breaks_before_peak,breaks_soon_after,breaks_in_last_quarter,strain_of_fastest_breaking"
    curve_head = "key,strain,eps_d,q,eps_v,broken"
    profile_head = "key,x [m],deflection [m],euler [m],timoshenko [m]"
    read_old(out "/profiles.csv", profile_lines, profile_head)
    read_old(out "/paths.csv", path_lines, path_head)
    read_old(out "/curves.csv", curve_lines, curve_head)
    for (i = 1; i <= n_runs; i++) {
        key = cell[i, "key"]
        if (cell[i, "group"] == "cantilever" && (text = profile_of(key)) != "")
            profile_lines[key] = text
        if (cell[i, "ended_by"] != "true_triaxial.stages" || cell[i, "strain_at_peak"] == "" || !(n = read_curve(key, c)))
            continue
        path_lines[key] = key "," path_of(c, n, cell[i, "strain_at_peak"] + 0) "\n"
        if (cell[i, "specimen.seed"] == 1 || cell[i, "specimen.seed"] == "")
            curve_lines[key] = curve_of(key, c, n)
    }
    write_all(out "/paths.csv", path_head, path_lines)
    write_all(out "/profiles.csv", profile_head, profile_lines)
    write_all(out "/curves.csv", curve_head, curve_lines)
}
