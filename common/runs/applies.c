/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether keys apply. A key without effect is an error, not a warning: whoever gives it believes
 * that it acts, and reads the result so. Expressions are read each time: they are short, and
 * parsing ahead would need a second form of the same declaration. Called by case.c as a case is
 * read, and by case_keep.c for what is kept. */
#include "common/runs/applies.h"

#include <stdio.h>
#include <string.h>

enum { TEXT_SIZE = 320 };

/* One part "section.key=a|b" of a clause. Clauses, parted by commas, must all hold; of the parts of
 * a clause, parted by " or ", one must. */
struct part {
    char section[BRC_CASEFILE_KEY_SIZE], key[BRC_CASEFILE_KEY_SIZE];
    const char *choices; /* behind the = */
    size_t length;       /* of the choices */
    bool is_last;        /* of its clause */
    const char *next;    /* behind the part and what parts it from the next */
};

/* Reads the part at text; false when there is none. A key without a section is of the same one. */
static bool read_part(const char *text, const char *section, struct part *p)
{
    size_t n = strcspn(text, "=,"), dot = strcspn(text, ".=,");
    if (text[n] != '=')
        return false;
    bool is_far = dot < n;
    snprintf(p->section, sizeof p->section, "%.*s", is_far ? (int)dot : (int)strlen(section),
             is_far ? text : section);
    const char *key = is_far ? text + dot + 1 : text;
    snprintf(p->key, sizeof p->key, "%.*s", (int)(text + n - key), key);
    p->choices = text + n + 1;
    p->length = strcspn(p->choices, " ,");
    p->next = p->choices + p->length;
    p->is_last = strncmp(p->next, " or ", 4) != 0;
    p->next += p->is_last ? strspn(p->next, ", ") : 4;
    return true;
}

/* `*` stands for the tests that name the key themselves, so that a new test changes no list. */
static bool is_one_of(const char *text, const struct part *part, const char *key)
{
    if (*part->choices == '*') {
        int kind = brc_rigs_find(text);
        return kind >= 0 && brc_rigs_uses(brc_rigs_at(kind), key);
    }
    size_t n = strlen(text);
    for (const char *c = part->choices; c < part->choices + part->length;) {
        size_t length = strcspn(c, "| ,");
        if (length == n && strncmp(c, text, n) == 0)
            return true;
        c += length + (c[length] == '|');
    }
    return false;
}

/* What a key is now: a choice, a number, or 0 for any zero: `dt=0` is meant whatever unit it is
 * printed in. */
static const char *value_text(const struct brc_param *p, const void *values, char text[TEXT_SIZE])
{
    const void *at = (const char *)values + p->offset;
    bool is_zero = (p->kind == BRC_REAL && *(const double *)at == 0) ||
                   (p->kind == BRC_INT && *(const int *)at == 0);
    return is_zero ? "0" : brc_params_text(p, values, text, TEXT_SIZE);
}

/* Whether a part is true of the case. A part that names no key is a mistake in a declaration, found
 * by the first case that meets it. */
static int holds(struct brc_context *ctx, const struct brc_case *run_case, const struct part *part,
                 const char *key, bool *does)
{
    char text[TEXT_SIZE];
    struct brc_case_section s;
    const struct brc_param *p = brc_case_find_section(run_case, part->section, &s)
                                    ? brc_params_find(s.list, part->key)
                                    : NULL;
    if (!p)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "'%s.%s' is not a key that another one can hang on",
                 part->section, part->key);
    *does = is_one_of(value_text(p, s.values, text), part, key);
    return 0;
}

/* Clause by clause: the first that fails is the one that a message names. */
int brc_applies(struct brc_context *ctx, const struct brc_case *run_case, const char *section,
                const struct brc_param *p, const char **clause)
{
    struct part part;
    bool is_true = false;
    *clause = NULL;
    for (const char *at = p->applies, *start = at; at && *at; at = part.next) {
        bool does;
        if (!read_part(at, section, &part))
            BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s.%s: cannot read '%s'", section, p->key, p->applies);
        BRC_TRY(holds(ctx, run_case, &part, p->key, &does));
        is_true = is_true || does;
        if (!part.is_last)
            continue;
        if (!is_true) {
            *clause = start;
            return 0;
        }
        start = part.next;
        is_true = false;
    }
    return 0;
}

/* Whether --set gives a key that the clause hangs on. */
static bool is_overridden(const struct brc_case *run_case, const char *section, const char *clause)
{
    struct part part = {.next = clause};
    while (!part.is_last && read_part(part.next, section, &part)) {
        struct brc_case_section s;
        brc_case_find_section(NULL, part.section, &s);
        const struct brc_casefile_entry *e =
            brc_casefile_find_entry(&run_case->file, part.section, part.key, s.list);
        if (e && e->is_override)
            return true;
    }
    return false;
}

/* Does the expression hang on the key of the part? */
static bool mentions(const char *applies, const char *section, const struct part *wanted)
{
    struct part part;
    for (const char *at = applies; at && read_part(at, section, &part); at = part.next)
        if (strcmp(part.section, wanted->section) == 0 && strcmp(part.key, wanted->key) == 0)
            return true;
    return false;
}

/* Keys of the section that apply by the same deciding key: "a, b". Whoever has taken the wrong key
 * finds the right one in the message. */
static int list_others(struct brc_context *ctx, const struct brc_case *run_case,
                       const struct brc_case_section *s, const struct part *decider,
                       char text[TEXT_SIZE])
{
    text[0] = '\0';
    for (int i = 0; i < s->list.n; i++) {
        const char *clause;
        const struct brc_param *p = &s->list.params[i];
        if (!mentions(p->applies, s->name, decider))
            continue;
        BRC_TRY(brc_applies(ctx, run_case, s->name, p, &clause));
        if (!clause)
            brc_names_add(text, TEXT_SIZE, p->key);
    }
    return 0;
}

/* The clause up to its end or a comma, `*` written out: readers of a message do not know what it
 * stands for. */
static const char *clause_text(const char *clause, const char *key, char text[TEXT_SIZE])
{
    int n = (int)strcspn(clause, ",*"), used = snprintf(text, TEXT_SIZE, "%.*s", n, clause);
    for (int i = 0; clause[n] == '*' && i < brc_rigs_count(); i++)
        if (brc_rigs_uses(brc_rigs_at(i), key) && used < TEXT_SIZE)
            used += snprintf(text + used, (size_t)(TEXT_SIZE - used), "%s%s",
                             text[used - 1] == '=' ? "" : "|", brc_rigs_at(i)->name);
    return text;
}

/* The message names the clause that fails, what decides it and where that comes from, as the reader
 * may not have written it. */
static int refuse(struct brc_context *ctx, const struct brc_case *run_case,
                  const struct brc_case_section *s, const struct brc_casefile_entry *e,
                  const char *clause)
{
    struct part part;
    struct brc_case_section far;
    char where[BRC_CASEFILE_WHERE_SIZE], text[TEXT_SIZE], others[TEXT_SIZE], said[TEXT_SIZE];
    read_part(clause, s->name, &part);
    brc_case_find_section(run_case, part.section, &far);
    const struct brc_param *p = brc_params_find(far.list, part.key);
    const struct brc_casefile_entry *given =
        brc_casefile_find_entry(&run_case->file, part.section, part.key, far.list);
    BRC_TRY(list_others(ctx, run_case, s, &part, others));
    BRC_FAIL(ctx, BRC_ERR_INPUT,
             "%s: %s.%s: applies only with %s, but %s.%s is %s%s; leave the key out, or change "
             "%s.%s%s%s",
             brc_casefile_where(&run_case->file, e->line, e->is_override, where), s->name,
             brc_casefile_key(e, s->list), clause_text(clause, e->key, said), part.section,
             part.key, value_text(p, far.values, text), given ? "" : " (its default)", part.section,
             part.key, *others ? "; what applies now is " : "", others);
}

/* A key of the file that an override has made meaningless gets its default: the user has said that
 * this run is another one, and editing the file for it would be a nuisance. */
static int check_key(struct brc_context *ctx, const struct brc_case *run_case,
                     const struct brc_case_section *s, const struct brc_param *p)
{
    const char *clause;
    const struct brc_casefile_entry *e =
        brc_casefile_find_entry(&run_case->file, s->name, p->key, s->list);
    if (!e)
        return 0;
    BRC_TRY(brc_applies(ctx, run_case, s->name, p, &clause));
    if (!clause)
        return 0;
    if (e->is_override || !is_overridden(run_case, s->name, clause))
        return refuse(ctx, run_case, s, e, clause);
    return brc_params_set(ctx, s->list, s->values, s->name, p->key, p->default_text, "default");
}

/* Of keys without a declaration nothing is asked: they always apply. */
int brc_applies_check(struct brc_context *ctx, const struct brc_case *run_case,
                      const struct brc_case_section *section)
{
    for (int k = 0; k < section->list.n; k++)
        if (section->list.params[k].applies)
            BRC_TRY(check_key(ctx, run_case, section, &section->list.params[k]));
    return 0;
}
