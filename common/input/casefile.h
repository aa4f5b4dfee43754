/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Case files: YAML (libyaml) with one mapping per section, kept as a list of (section, key, text,
 * line) and judged by the parameter lists. The files casefile*.c alone have yaml.h.
 *
 *     breccia: 1
 *     title: Unconfined compression
 *     model: vgcm
 *     specimen: {shape: cylinder, diameter: 36 mm}
 *     vgcm: {e_bar: 48.8 GPa, interaction: {rule: gap, gap: 1 mm}}
 *
 * A nested mapping a: {b: c} is the key a_b; a: {rule: x} is the key a where a list has a but no
 * a_rule. A sequence [1 m, 2 m, 3 m] is the text "1 m, 2 m, 3 m". */
#ifndef BRC_CASEFILE_H
#define BRC_CASEFILE_H

#include "common/input/params.h"

enum {
    BRC_CASEFILE_VERSION = 1,
    BRC_CASEFILE_MAX_BYTES = 1 << 20,
    BRC_CASEFILE_MAX_LEVELS = 3,
    BRC_CASEFILE_MAX_ENTRIES = 4096,
    BRC_CASEFILE_KEY_SIZE = 64,
    BRC_CASEFILE_WHERE_SIZE = 256,
    BRC_CASEFILE_MAX_MODELS = 16
};

/* Keys of the top level. */
#define BRC_CASEFILE_PARAMS(REAL, INT, CHOICE, FLAG, TEXT, REAL3, INT3) \
    INT(breccia, NULL, "[1, 1]", "version of the case format")          \
    TEXT(title, "", "one line for headings")                            \
    TEXT(model, "", "contact model that `run` uses")                    \
    TEXT(models, "", "contact models that `compare` uses; empty: all")

/* The top level is a parameter list like those of sections, so that its keys have the same
 * messages. */
struct brc_casefile_params {
    BRC_PARAM_MEMBERS(BRC_CASEFILE_PARAMS)
};
extern const struct brc_param_list brc_casefile_param_list;

/* One key with its text, as the file or --set gives it. What it means is decided by the section's
 * list, which the reader does not know; so the text is kept, with its place for messages, and with
 * the bytes that hold it for the writer. */
struct brc_casefile_entry {
    char section[BRC_CASEFILE_KEY_SIZE]; /* "" at the top level */
    char key[BRC_CASEFILE_KEY_SIZE];     /* nested keys joined by _ */
    char parent[BRC_CASEFILE_KEY_SIZE];  /* a of a: {rule: x}, else "" */
    char *text;
    int line;          /* 1 is the first; 0: not from the file */
    bool is_override;  /* from --set */
    size_t key_begin;  /* byte of the case's text where the key starts */
    size_t begin, end; /* bytes that hold the value */
    int place;         /* of the mapping in the case's sections, -1: the root */
    int indent;        /* blanks that a value without line breaks needs before it there */
};

/* How a mapping stands in the file: a new key is added to each in another way. */
enum brc_casefile_form {
    BRC_CASEFILE_ABSENT, /* by --set only */
    BRC_CASEFILE_NULL,   /* `vgcm:` */
    BRC_CASEFILE_EMPTY,  /* `vgcm: {}` */
    BRC_CASEFILE_FLOW,   /* `vgcm: {e_bar: 48.8 GPa}` */
    BRC_CASEFILE_BLOCK   /* keys on lines of their own */
};

/* Where a section, or a nested mapping "section.key", was opened. Sections that hold nothing have
 * one, too: `vgcm:` alone names a section that must be known. */
struct brc_casefile_place {
    char name[2 * BRC_CASEFILE_KEY_SIZE];
    int line; /* 0: by --set only */
    enum brc_casefile_form form;
    size_t begin, end; /* bytes: of a null value; else end is behind the last value */
    int indent;        /* column of the keys */
};

/* A case file as read. Freed by brc_casefile_free, also after a failed read. */
struct brc_casefile {
    char *path;
    char *text; /* the file's bytes; overrides are no part of them */
    struct brc_casefile_place root;
    struct brc_casefile_entry *entries;
    size_t n, cap;
    struct brc_casefile_place *sections;
    size_t n_sections, cap_sections;
    struct brc_casefile_params head; /* top-level keys */
    size_t n_models;                 /* names in `models`; 0: all */
    char models[BRC_CASEFILE_MAX_MODELS][BRC_CASEFILE_KEY_SIZE];
};

/* Reads a file into a case, which need not be initialised, and judges the top level. */
int brc_casefile_read(struct brc_context *ctx, const char *path, struct brc_casefile *c);
/* The same from memory, of which a copy is kept; path names the text in messages. For cases that
 * come out of a state, and for the writer, which reads its own text again. */
int brc_casefile_parse(struct brc_context *ctx, const char *path, const char *text, size_t size,
                       struct brc_casefile *c);
/* Applies "section.key=text" (or "title=text") of the command line; the last one of a key holds. A
 * bad form is BRC_ERR_USAGE, a bad key or value is found with the section. */
int brc_casefile_override(struct brc_context *ctx, struct brc_casefile *c, const char *assignment);
/* Fills values from the list's defaults, the section's entries and the overrides. Unknown and
 * missing keys, bad values and a key given twice are errors. */
int brc_casefile_section(struct brc_context *ctx, const struct brc_casefile *c, const char *section,
                         struct brc_param_list list, void *values);
/* Checks and fills the keys of the top level, overrides included. Called by the reader and after
 * each override: other code may rely on c->head. */
int brc_casefile_top_level(struct brc_context *ctx, struct brc_casefile *c);
/* Where a section was opened, NULL when neither the file nor an override has it. */
const struct brc_casefile_place *brc_casefile_find_section(const struct brc_casefile *c,
                                                           const char *section);
/* The entry that gives a key its value, NULL when it has its default. */
const struct brc_casefile_entry *brc_casefile_find_entry(const struct brc_casefile *c,
                                                         const char *section, const char *key,
                                                         struct brc_param_list list);
/* "file.yaml:12", "file.yaml" for line 0, or "--set" for an override; returns where. Of a long path
 * the end is shown. */
const char *brc_casefile_where(const struct brc_casefile *c, int line, bool is_override,
                               char where[BRC_CASEFILE_WHERE_SIZE]);
/* Checks the names of the sections against those that there are, after all were read; unknown ones
 * are errors with the nearest name. Nested mappings were checked as keys. */
int brc_casefile_finish(struct brc_context *ctx, const struct brc_casefile *c,
                        const char *const *sections, size_t n);
/* Gives a key, as the section's list calls it, this value in the text of a case without overrides:
 * in its place where the file gives the key, else as the last of its section. All other bytes stay.
 * The case is then the one that the new text makes. */
int brc_casefile_write(struct brc_context *ctx, struct brc_casefile *c, const char *section,
                       const char *key, struct brc_param_list list, const char *value);
/* Takes a key out of the text of a case without overrides, with the line that it has to itself and
 * the comment on it. */
int brc_casefile_remove(struct brc_context *ctx, struct brc_casefile *c, const char *section,
                        const char *key, struct brc_param_list list);
/* Valid UTF-8 without control characters, but for line breaks and tabs: what may stand in a case,
 * and so what a name that is put there must be. */
bool brc_casefile_is_text(const char *text);
/* The list's key that an entry means: a: {rule: x} stands for a where there is no a_rule, and an
 * older name for the present one. */
const char *brc_casefile_key(const struct brc_casefile_entry *e, struct brc_param_list list);
/* Accepts a zeroed or half-read case. */
void brc_casefile_free(struct brc_casefile *c);

#endif
