# SPDX-License-Identifier: GPL-3.0-or-later
# Numbers and claims of a paper beside ours, from the runs of a sweep: what cases/<paper>/targets.awk is
# written with. Its END block calls `target` and `claim` for each entry; docs/make-paper says
#     awk -f cases/paper.awk -f cases/<paper>/targets.awk -v out=FOLDER runs.csv > table.md
# which writes FOLDER/targets.json and the data of plots, too.
#
# A value is a mean over the packs (seeds) of a place of the sweep, "group=table2;test=tension"; what
# is derived from several runs (a ratio, a slope) is derived pack by pack, so that its error is too.

# one line of CSV into part[1..n]; runs.csv quotes messages
function split_csv(line, part,    n, at, field) {
    n = 0
    while (1) {
        if (substr(line, 1, 1) == "\"") {
            field = ""
            line = substr(line, 2)
            while ((at = index(line, "\"")) && substr(line, at + 1, 1) == "\"") {
                field = field substr(line, 1, at)
                line = substr(line, at + 2)
            }
            part[++n] = field substr(line, 1, at - 1)
            line = substr(line, at + 1)
        } else {
            at = index(line, ",")
            part[++n] = at ? substr(line, 1, at - 1) : line
            line = at ? substr(line, at) : ""
        }
        if (line == "")
            return n
        line = substr(line, 2)
    }
}

FNR == 1 {
    n_columns = split_csv($0, column)
    for (i = 1; i <= n_columns; i++)
        sub(/ \[.*/, "", column[i])
    next
}
{
    n_runs++
    split_csv($0, part)
    for (i = 1; i <= n_columns; i++)
        cell[n_runs, column[i]] = part[i]
}

# --- means over packs ---------------------------------------------------------------------------

function is_at(run, place,    pair, k, n, at) {
    n = split(place, pair, ";")
    for (k = 1; k <= n; k++) {
        at = index(pair[k], "=")
        if (cell[run, substr(pair[k], 1, at - 1)] != substr(pair[k], at + 1))
            return 0
    }
    return 1
}

# what makes two packs different: the seed, or the size of the triangles of a mesh, which has none
function sample(run) { return cell[run, "specimen.seed"] cell[run, "specimen.triangle_area"] }

# x[seed] of a quantity at a place; how many
function packs(place, quantity, x,    i, n) {
    split("", x)
    n = 0
    for (i = 1; i <= n_runs; i++)
        if (is_at(i, place) && cell[i, "code"] == 0 && cell[i, quantity] != "") {
            x[sample(i)] = cell[i, quantity] + 0
            n++
        }
    return n
}

# mean of x; the globals n_of and se_of are of the same values
function mean(x,    k, sum, squares, m) {
    n_of = sum = squares = 0
    for (k in x) {
        n_of++
        sum += x[k]
    }
    m = n_of ? sum / n_of : 0
    for (k in x)
        squares += (x[k] - m) ^ 2
    se_of = n_of > 1 ? sqrt(squares / (n_of - 1) / n_of) : 0
    return m
}

function value(place, quantity,    x) {
    packs(place, quantity, x)
    return mean(x)
}

# x / y, pack by pack
function ratio(x, y, z,    k) {
    split("", z)
    for (k in x)
        if (k in y)
            z[k] = x[k] / y[k]
}

# --- entries ------------------------------------------------------------------------------------

# Values of packs x[] in SI, printed as x * scale, beside the paper's number and its error (0: none given).
# choices: a place that lacks its choice, "group=choices;test=tension;choice=": runs that might explain a difference; "": none.
function target(name, figure, paper, paper_se, unit, scale, x, choices, quantity,    i) {
    i = ++n_entries
    e_name[i] = name
    e_figure[i] = figure
    e_paper[i] = paper
    e_unit[i] = unit
    e_ours[i] = mean(x) * scale
    e_se[i] = se_of * (scale < 0 ? -scale : scale)
    e_n[i] = n_of
    e_far[i] = e_ours[i] - paper
    e_error[i] = 2 * sqrt(e_se[i] ^ 2 + paper_se ^ 2)
    e_agrees[i] = n_of >= 6 && e_se[i] < 0.03 * size(e_ours[i]) &&
                  (size(e_far[i]) <= 0.05 * size(paper) || size(e_far[i]) <= e_error[i])
    if (choices != "" && !e_agrees[i])
        weigh(i, choices, quantity, scale)
}

# A claim in words holds by a criterion on a value of ours, which is true or false already.
function claim(name, figure, criterion, holds, x, scale, unit,    i) {
    i = ++n_entries
    e_name[i] = name
    e_figure[i] = figure
    e_paper[i] = criterion
    e_is_claim[i] = 1
    e_unit[i] = unit
    e_ours[i] = mean(x) * scale
    e_se[i] = se_of * scale
    e_n[i] = n_of
    e_agrees[i] = n_of > 0 && holds
}

function size(x) { return x < 0 ? -x : x }

# Each choice that the paper leaves open: what part of the gap it closes. From a half on (and not
# twice as far beyond) it explains; below a quarter it is excluded; between them it is a part of the reason.
function weigh(i, choices, quantity, scale,    k, m, tried) {
    split("", tried)
    for (k = 1; k <= n_choices; k++) {
        m = value(choices choice_name[k], quantity)
        if (n_of)
            tried[choice_name[k]] = m
    }
    weigh_tried(i, tried, scale)
}

# The same by tried[choice], means that have been found already: of what is derived from several runs.
function weigh_tried(i, tried, scale,    k, moved, best, base, name, part) {
    if (!("as read" in tried))
        return
    best = 1e9
    base = tried["as read"] * scale
    for (k = 1; k <= n_choices; k++) {
        if (!(choice_name[k] in tried) || choice_name[k] == "as read")
            continue
        moved = (tried[choice_name[k]] * scale - base) / (e_paper[i] - base)
        if (moved == 0)
            continue # a choice that has no part in this test
        name = sprintf("%s (%+.0f %% of the gap)", choice_name[k], 100 * moved)
        if (moved > 0.5 && moved < 2 && size(moved - 1) < best) {
            best = size(moved - 1)
            e_why[i] = name
        } else if (moved < 0.25)
            e_not[i] = e_not[i] (e_not[i] ? "; " : "") name
        else if (moved < 0.5)
            part = part (part ? "; " : "in part: ") name
    }
    if (!e_why[i])
        e_why[i] = part
}

# Weighs the last entry, if it does not agree.
function weigh_last(tried, scale) {
    if (!e_agrees[n_entries])
        weigh_tried(n_entries, tried, scale)
}

# The last entry is no test of the model: it was put in, or a choice was made by it.
function put_in() { e_is_input[n_entries] = 1 }

# Why the last entry is as it is, where no choice is weighed: by the caller's own runs.
function explain(why, not_by) {
    if (e_agrees[n_entries])
        return
    e_why[n_entries] = why
    e_not[n_entries] = not_by
}

function choices_of(list,    k) {
    n_choices = split(list, choice_name, "|")
}

# One line of a plot's data: place on the axis, mean and standard error in units of 1 / scale.
function point(file, at, x, scale,    m) {
    m = mean(x) * scale
    if (n_of)
        print at, m, se_of * scale >file
}

# --- precision ----------------------------------------------------------------------------------

# mean of (y - x) / x [%], paired over packs; se_of is its error
function change(x, y,    k, z) {
    split("", z)
    for (k in x)
        if (k in y)
            z[k] = 100 * (y[k] - x[k]) / x[k]
    return mean(z)
}

# A cell of the table: change by a finer setting, and whether it is within the bound [%] or two of its standard errors
function change_cell(place, base, numerics, quantity, bound,    x, y, m) {
    packs(place base, quantity, x)
    packs(place numerics, quantity, y)
    m = change(x, y)
    if (n_of < 2)
        return "not run"
    n_changes++
    if (size(m) < bound || size(m) < 2 * se_of)
        n_small++
    return sprintf("%+.2f +- %.2f %%%s", m, se_of, size(m) < bound ? "" : size(m) < 2 * se_of ? " (within 2 errors)" : " **(no)**")
}

# Below a table of such cells: how many are small, how well the energy adds up in all runs that the tables stand on, and their cost
function write_changes(    i, n, worst, drift, failed, hours, seen) {
    printf "\n%d of %d changes are below 2 %% for the target and 1 %% for the time step, or below two of their standard errors (paired over the packs). ", n_small, n_changes
    for (i = 1; i <= n_runs; i++) {
        if (cell[i, "key"] == "" || cell[i, "key"] in seen)
            continue
        seen[cell[i, "key"]]
        n++
        hours += cell[i, "cpu_s"] / 3600
        failed += cell[i, "code"] != 0
        if (cell[i, "code"] == 0 && size(cell[i, "energy_residual"] + 0) > worst)
            worst = size(cell[i, "energy_residual"] + 0)
        if (cell[i, "code"] == 0 && cell[i, "energy_drift"] + 0 > drift)
            drift = cell[i, "energy_drift"] + 0
    }
    printf "The energy of the %d runs, of %.1f hours on one core, adds up within %.1e of the work done, and what is stored drifts by %.2g of it at most; %d failed.\n",
        n, hours, worst, drift, failed
}

# --- what is written ----------------------------------------------------------------------------

function number(x) { return sprintf("%.4g", x) }

function write_json(file,    i) {
    printf "[" >file
    for (i = 1; i <= n_entries; i++) {
        printf "%s\n  {\"name\": \"%s\", \"figure\": \"%s\", ", (i == 1 ? "" : ","), e_name[i], e_figure[i] >file
        printf "\"paper\": %s, ", (e_is_claim[i] ? "\"" e_paper[i] "\"" : e_paper[i]) >file
        printf "\"ours\": %s, \"se\": %s, \"n_samples\": %d, \"unit\": \"%s\", ", (e_n[i] ? number(e_ours[i]) : "null"),
            (e_n[i] == 1 || !e_n[i] ? "null" : number(e_se[i])), e_n[i], e_unit[i] >file
        printf "\"ratio\": %s, ", ratio_of(i, "null", "%.4g") >file
        printf "\"agrees\": %s, \"explained_by\": \"%s\", \"excluded\": \"%s\"}", (e_agrees[i] ? "true" : "false"),
            e_why[i], e_not[i] >file
    }
    print "\n]" >file
    close(file)
}

function ratio_of(i, none, format) {
    return e_is_claim[i] || !e_n[i] || !e_paper[i] ? none : sprintf(format, e_ours[i] / e_paper[i])
}

function write_table(    i, agreed, inputs) {
    print "| what | where | paper | ours | ratio | agrees |"
    print "|---|---|---|---|---|---|"
    for (i = 1; i <= n_entries; i++) {
        agreed += e_agrees[i]
        inputs += e_is_input[i]
        printf "| %s | %s | %s%s | %s | %s | %s |\n", e_name[i], e_figure[i], e_paper[i],
            (e_is_claim[i] ? "" : " " e_unit[i]), ours_of(i), ratio_of(i, "", "%.2f"),
            (e_agrees[i] ? (e_is_input[i] ? "yes, put in" : "yes") : !e_n[i] ? "not run" : e_n[i] < 6 && !e_is_claim[i] ? "too few packs" : "no" why_of(i))
    }
    printf "\n%d of %d agree%s: within 5 %% or two standard errors, for at least 6 packs with a standard error below 3 %%; ", agreed,
        n_entries, (inputs ? sprintf(", %d of them because they were put in", inputs) : "")
    print "claims by the criterion beside them."
}

function ours_of(i) {
    return !e_n[i] ? "" : number(e_ours[i]) (e_n[i] == 1 ? "" : " +- " sprintf("%.2g", e_se[i])) " " e_unit[i] " (" e_n[i] ")"
}

function why_of(i) {
    return (e_why[i] ? "; explained " (e_why[i] ~ /^in part/ ? "" : "by ") e_why[i] : e_is_claim[i] ? "" : "; unexplained") (e_not[i] ? "; not by " e_not[i] : "")
}
