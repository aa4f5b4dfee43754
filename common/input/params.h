/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parameter lists: each case-file section (specimen, test, run, output, and one per model) is
 * declared once as an X-macro; the struct, the reader, the range checks and the reference printed
 * by `breccia params` all come from it.
 *
 *     #define VGCM_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3)                        \
 *         REAL(e_bar, "Pa", "48.8 GPa", "(0, inf)", "contact modulus E-bar, eq 28")          \
 *         CHOICE(interaction, "all|gap|area", "gap", "which facets are contacts")
 *     struct law_params { BRC_PARAM_MEMBERS(LAW_PARAMS) };
 *     #define BRC_OWNER struct law_params
 *     static const struct brc_param law_param_list[] = { BRC_PARAM_LIST(LAW_PARAMS) };
 *     #undef BRC_OWNER
 */
#ifndef BRC_PARAMS_H
#define BRC_PARAMS_H

#include "common/base/error.h"
#include "common/base/names.h"

#include <stdio.h>
#include <string.h>

enum brc_param_kind {
    BRC_REAL,   /* double, SI; NAN: `auto`, where that is the default */
    BRC_INT,    /* int */
    BRC_CHOICE, /* int: position in the |-separated list of choices */
    BRC_FLAG,   /* int: on = 1, off = 0 */
    BRC_TEXT,   /* char[BRC_TEXT_SIZE] */
    BRC_REAL3,  /* double[3], SI */
    BRC_INT3    /* int[3] */
};
enum { BRC_TEXT_SIZE = 256 };
/* Default text of a BRC_REAL that its owner finds from other keys and the specimen. */
#define BRC_AUTO "auto"

struct brc_param {
    const char *key;
    enum brc_param_kind kind;
    unsigned flags;           /* enum brc_param_flags; last in a row: "meaning", .flags = ... */
    const char *unit;         /* SI unit as UDUNITS-2 reads it; "1" for a pure number */
    const char *default_text; /* as written in a case file; NULL: must be given */
    const char *range;        /* interval in SI units, "(0, inf)", "[0, 1]"; NULL: any */
    const char *choices;      /* CHOICE only */
    size_t offset;
    const char *meaning;
    /* Where other keys decide whether this one has a meaning, else NULL: clauses "key=a|b" between
     * commas, each of which must hold; " or " stands between the parts of a clause. A key of
     * another section is "section.key"; a value is a choice, auto or 0. To give the key elsewhere
     * is an error, see applies.h. */
    const char *applies;
    const char *renamed; /* the key's name in older cases, which is still read; else NULL */
    /* Of an option that was added: the value with which all is as it was without the key. Results
     * that were kept before stay valid by it (run_key.h); else NULL. */
    const char *off;
};

/* A part of what a result hangs on beside its keys, with a number that moves when the part computes
 * otherwise: a result that was kept under another number is not taken any more (run_key.h). */
struct brc_physics {
    const char *part; /* NULL: the end of a list */
    int version;
    const char *when; /* the part counts where this holds, as brc_param.applies; NULL: always */
};

/* What others must know of a key stands with its declaration, so that a new key is complete in one
 * place: lists of names elsewhere went stale without a word. */
enum brc_param_flags {
    BRC_PARAM_MAY_CHANGE = 1, /* may differ when a run resumes: no state depends on it */
    BRC_PARAM_AXIS = 2,       /* a choice that `breccia converge` varies unless told otherwise */
    BRC_PARAM_FILE = 4,       /* TEXT: a file; what counts for a state is what it holds */
    BRC_PARAM_COST = 8        /* changes no bit of a result: time and files alone */
};

/* A list with the size of the struct that it describes. Passed by value: it is three words, and
 * lists that are changed for one use (calib/target.c) need no owner. */
struct brc_param_list {
    const struct brc_param *params;
    int n;
    size_t owner_size;
};
#define BRC_PARAMS(list, owner)                                      \
    {                                                                \
        (list), (int)(sizeof(list) / sizeof(list)[0]), sizeof(owner) \
    }

/* After what is named here come the meaning, when the key applies where it is not always, and flags
 * and an older name by their designators. */
#define BRC_PARAM_M_REAL(name, u, d, r, ...)  double name;
#define BRC_PARAM_M_INT(name, ...)            int name;
#define BRC_PARAM_M_TEXT(name, d, ...)        char name[BRC_TEXT_SIZE];
#define BRC_PARAM_M_REAL3(name, u, d, r, ...) double name[3];
#define BRC_PARAM_M_INT3(name, d, r, ...)     int name[3];
#define BRC_PARAM_MEMBERS(LIST)                                                                 \
    LIST(BRC_PARAM_M_REAL, BRC_PARAM_M_INT, BRC_PARAM_M_INT, BRC_PARAM_M_INT, BRC_PARAM_M_TEXT, \
         BRC_PARAM_M_REAL3, BRC_PARAM_M_INT3)

#define BRC_PARAM_ROW(name, k, u, d, r, c, ...) \
    {.key = #name,                              \
     .kind = k,                                 \
     .unit = u,                                 \
     .default_text = d,                         \
     .range = r,                                \
     .choices = c,                              \
     .offset = offsetof(BRC_OWNER, name),       \
     .meaning = __VA_ARGS__},
#define BRC_PARAM_L_REAL(name, u, d, r, ...) \
    BRC_PARAM_ROW(name, BRC_REAL, u, d, r, NULL, __VA_ARGS__)
#define BRC_PARAM_L_INT(name, d, r, ...) BRC_PARAM_ROW(name, BRC_INT, "1", d, r, NULL, __VA_ARGS__)
#define BRC_PARAM_L_CHOICE(name, c, d, ...) \
    BRC_PARAM_ROW(name, BRC_CHOICE, "1", d, NULL, c, __VA_ARGS__)
#define BRC_PARAM_L_FLAG(name, d, ...) \
    BRC_PARAM_ROW(name, BRC_FLAG, "1", d, NULL, "off|on", __VA_ARGS__)
#define BRC_PARAM_L_TEXT(name, d, ...) \
    BRC_PARAM_ROW(name, BRC_TEXT, "1", d, NULL, NULL, __VA_ARGS__)
#define BRC_PARAM_L_REAL3(name, u, d, r, ...) \
    BRC_PARAM_ROW(name, BRC_REAL3, u, d, r, NULL, __VA_ARGS__)
#define BRC_PARAM_L_INT3(name, d, r, ...) \
    BRC_PARAM_ROW(name, BRC_INT3, "1", d, r, NULL, __VA_ARGS__)
#define BRC_PARAM_LIST(LIST)                                                      \
    LIST(BRC_PARAM_L_REAL, BRC_PARAM_L_INT, BRC_PARAM_L_CHOICE, BRC_PARAM_L_FLAG, \
         BRC_PARAM_L_TEXT, BRC_PARAM_L_REAL3, BRC_PARAM_L_INT3)

/* An SI unit behind a number: for a pure number, whose unit is "1", nothing follows. */
static inline const char *brc_unit_shown(const char *unit)
{
    return strcmp(unit, "1") == 0 ? "" : unit;
}
static inline const char *brc_unit_blank(const char *unit)
{
    return *brc_unit_shown(unit) ? " " : "";
}

/* Fills a parameter struct with the defaults; keys without a default are left zero. */
int brc_params_defaults(struct brc_context *ctx, struct brc_param_list list, void *values);
/* Sets one key from text ("48.8 GPa"); where names the place for the message ("file.yaml:12").
 * BRC_ERR_INPUT for what a user can mend, with the place, the key and what is allowed; the struct
 * is then as it was. */
int brc_params_set(struct brc_context *ctx, struct brc_param_list list, void *values,
                   const char *section, const char *key, const char *text, const char *where);
/* Text of a value, in the unit of its default where it has one, with as many digits as read back to
 * the same bits; of a choice its name. Returns buffer; a text that is too long for it is cut. */
const char *brc_params_text(const struct brc_param *p, const void *values, char *buffer,
                            size_t size);
/* Value of a quantity text ("48.8 GPa") in the SI unit given; "1" is a pure number, which has no
 * unit. Powers of ten between the two units cost no digit. */
int brc_params_quantity(struct brc_context *ctx, const char *text, const char *unit, double *value,
                        const char *where);
/* The param of this key, NULL when there is none. Older names are not found by it: who reads a case
 * asks brc_params_renamed after it, all others have the present names. */
const struct brc_param *brc_params_find(struct brc_param_list list, const char *key);
/* The param that had this key as its name before, NULL when there is none. */
const struct brc_param *brc_params_renamed(struct brc_param_list list, const char *key);
/* "; did you mean 'key'?" for the nearest key, or ""; returns hint. */
const char *brc_params_hint(struct brc_param_list list, const char *key, char hint[BRC_HINT_SIZE]);
/* The param whose meaning has most of the words of the key, NULL when it has none of 4 letters:
 * youngs_modulus finds e_bar, "contact modulus". */
const struct brc_param *brc_params_meant(struct brc_param_list list, const char *key);
/* Reference table: key, default, allowed, unit, meaning, and where the key applies. Columns are as
 * wide as their longest text. */
void brc_params_print(FILE *out, const char *title, struct brc_param_list list);

#endif
