/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text to values and back. A value is written in the unit of its default with as many digits as
 * read back to the same bits, so that a kept case makes the same run. Conversions by powers of ten
 * move the exponent in the text: multiplying would make 5.1 mm another double than 0.0051 m. */
#include "common/input/params.h"
#include "common/input/units.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { PLACE_SIZE = 320 };

/* An interval such as "(0, inf)". */
struct interval {
    double low, high;
    bool low_open, high_open;
};

/* ---- numbers ------------------------------------------------------------------------------- */

/* Length of the decimal number that text starts with, 0 when there is none. Hexadecimal, inf and
 * nan, which strtod would take, are not numbers here. */
static size_t number_length(const char *text)
{
    const char *c = text;
    size_t digits = 0;
    if (*c == '+' || *c == '-')
        c++;
    for (; isdigit((unsigned char)*c); c++)
        digits++;
    if (*c == '.')
        for (c++; isdigit((unsigned char)*c); c++)
            digits++;
    if (digits == 0)
        return 0;
    if (*c == 'e' || *c == 'E') {
        const char *e = c + 1;
        if (*e == '+' || *e == '-')
            e++;
        if (isdigit((unsigned char)*e)) {
            while (isdigit((unsigned char)*e))
                e++;
            c = e;
        }
    }
    return (size_t)(c - text);
}

/* number times factor; powers of ten move the decimal exponent, so that "5.1 mm" and "0.0051 m" are
 * the same double. */
static double scaled_number(const char *number, size_t length, double factor)
{
    char text[BRC_TEXT_SIZE + 32];
    double power = log10(factor);
    int k = (int)lround(power);
    if (length >= BRC_TEXT_SIZE)
        return NAN;
    memcpy(text, number, length);
    text[length] = '\0';
    if (fabs(power - k) > 1e-13)
        return strtod(text, NULL) * factor;
    char *e = strpbrk(text, "eE");
    long exponent = e ? strtol(e + 1, NULL, 10) : 0;
    if (exponent > 9999 || exponent < -9999)
        return strtod(text, NULL);
    snprintf(e ? e : text + length, 32, "e%ld", exponent + k);
    return strtod(text, NULL);
}

/* Text without the blanks at its ends, in buffer; NULL when it does not fit. */
static const char *trimmed(const char *text, size_t n, char *buffer, size_t size)
{
    while (n > 0 && isspace((unsigned char)*text)) {
        text++;
        n--;
    }
    while (n > 0 && isspace((unsigned char)text[n - 1]))
        n--;
    if (n >= size)
        return NULL;
    memcpy(buffer, text, n);
    buffer[n] = '\0';
    return buffer;
}

/* Splits "48.8 GPa" into the number's length and the unit, "" when there is none. */
static size_t split_quantity(const char *text, const char **unit)
{
    size_t length = number_length(text);
    const char *rest = text + length;
    while (isspace((unsigned char)*rest))
        rest++;
    *unit = rest;
    return length;
}

int brc_params_quantity(struct brc_context *ctx, const char *text, const char *unit, double *value,
                        const char *where)
{
    char clean[BRC_TEXT_SIZE];
    const char *own, *example = strcmp(unit, "1") == 0 ? "" : " ";
    const char *shown = strcmp(unit, "1") == 0 ? "" : unit;
    double factor = 1;
    if (!trimmed(text, strlen(text), clean, sizeof clean))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s...' is too long for a quantity", where, text);
    size_t length = split_quantity(clean, &own);
    if (length > 0 && clean[length] == ',' && isdigit((unsigned char)clean[length + 1]))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' has a decimal comma; write a decimal point, '%.*s.%.40s', and no "
                 "mark between thousands",
                 where, clean, (int)length, clean, clean + length + 1);
    if (length == 0)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' does not start with a finite decimal number; write for example "
                 "'2.5e3%s%s'",
                 where, clean, example, shown);
    if (*own == '\0' && *shown != '\0')
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' has no unit; expected a unit of the dimension of %s, for example "
                 "'%.60s %s'",
                 where, clean, unit, clean, unit);
    if (*own != '\0')
        BRC_TRY(brc_units_factor(ctx, own, unit, where, &factor));
    double result = scaled_number(clean, length, factor);
    if (!isfinite(result))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is too large for a number", where, clean);
    size_t first_digit = strcspn(clean, "123456789");
    if (result == 0 && first_digit < length && first_digit < strcspn(clean, "eE"))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is too small for a number", where, clean);
    *value = result;
    return 0;
}

/* ---- intervals ----------------------------------------------------------------------------- */

static bool parse_bound(const char **text, double *value)
{
    char *end;
    *value = strtod(*text, &end);
    bool ok = end != *text && !isnan(*value);
    *text = end;
    return ok;
}

static bool parse_interval(const char *text, struct interval *r)
{
    r->low_open = *text == '(';
    if (*text != '(' && *text != '[')
        return false;
    text++;
    if (!parse_bound(&text, &r->low) || *text != ',')
        return false;
    text++;
    if (!parse_bound(&text, &r->high) || (*text != ')' && *text != ']'))
        return false;
    r->high_open = *text == ')';
    return text[1] == '\0' && r->low <= r->high;
}

static int check_range(struct brc_context *ctx, const struct brc_param *p, double value,
                       const char *text, const char *place)
{
    struct interval r;
    if (!p->range)
        return 0;
    if (!parse_interval(p->range, &r))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the declared range '%s' is not an interval", place,
                 p->range);
    bool inside = (r.low_open ? value > r.low : value >= r.low) &&
                  (r.high_open ? value < r.high : value <= r.high);
    if (inside)
        return 0;
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %.60s is out of range; allowed %s%s%s", place, text, p->range,
             strcmp(p->unit, "1") == 0 ? "" : " ", strcmp(p->unit, "1") == 0 ? "" : p->unit);
}

/* ---- one value of each kind ---------------------------------------------------------------- */

/* A default that is found later, from what else is known; NAN until then. */
static bool is_auto(const struct brc_param *p)
{
    return p->kind == BRC_REAL && p->default_text && strcmp(p->default_text, BRC_AUTO) == 0;
}

static int set_real(struct brc_context *ctx, const struct brc_param *p, double *to,
                    const char *text, const char *place)
{
    double value;
    if (is_auto(p) && strcmp(text, BRC_AUTO) == 0) {
        *to = NAN;
        return 0;
    }
    BRC_TRY(brc_params_quantity(ctx, text, p->unit, &value, place));
    BRC_TRY(check_range(ctx, p, value, text, place));
    *to = value;
    return 0;
}

static int set_int(struct brc_context *ctx, const struct brc_param *p, int *to, const char *text,
                   const char *place)
{
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    while (isspace((unsigned char)*end))
        end++;
    if (end == text || *end != '\0')
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' is not a whole number, written in digits; allowed %s", place, text,
                 p->range ? p->range : "any integer");
    if (errno == ERANGE || value > INT_MAX || value < INT_MIN)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %.60s is out of range; allowed %s", place, text,
                 p->range ? p->range : "[-2147483648, 2147483647]");
    BRC_TRY(check_range(ctx, p, (double)value, text, place));
    *to = (int)value;
    return 0;
}

/* Name k of a |-separated list in buffer; false past the last. */
static bool choice_name(const char *choices, int k, char *buffer, size_t size)
{
    for (; k > 0; k--) {
        choices = strchr(choices, '|');
        if (!choices)
            return false;
        choices++;
    }
    size_t n = strcspn(choices, "|");
    if (n >= size)
        n = size - 1;
    memcpy(buffer, choices, n);
    buffer[n] = '\0';
    return true;
}

static int set_choice(struct brc_context *ctx, const struct brc_param *p, int *to, const char *text,
                      const char *place)
{
    char name[BRC_NAME_SIZE], hint[BRC_HINT_SIZE];
    struct brc_nearest nearest = {.text = text};
    for (int k = 0; choice_name(p->choices, k, name, sizeof name); k++) {
        if (strcmp(name, text) == 0) {
            *to = k;
            return 0;
        }
        brc_nearest_add(&nearest, name);
    }
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is not a choice; allowed %.300s%s", place, text,
             p->choices, brc_nearest_hint(&nearest, hint));
}

static int set_flag(struct brc_context *ctx, int *to, const char *text, const char *place)
{
    static const char *const words[] = {"off", "on", "false", "true", "no", "yes"};
    for (int k = 0; k < 6; k++)
        if (strcasecmp(text, words[k]) == 0) {
            *to = k % 2;
            return 0;
        }
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is not a flag; allowed on, off, true, false, yes, no",
             place, text);
}

static int set_text(struct brc_context *ctx, char *to, const char *text, const char *place)
{
    if (strlen(text) >= BRC_TEXT_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: the text has %zu bytes; allowed at most %d", place,
                 strlen(text), BRC_TEXT_SIZE - 1);
    strcpy(to, text);
    return 0;
}

/* Three parts between commas. */
static int set_triple(struct brc_context *ctx, const struct brc_param *p, void *to,
                      const char *text, const char *place)
{
    char part[BRC_TEXT_SIZE];
    double real[3];
    int whole[3];
    const char *c = text;
    int n_commas = 0;
    for (const char *at = text; *at; at++)
        n_commas += *at == ',';
    for (int i = 0; i < 3; i++) {
        size_t n = strcspn(c, ",");
        if (n_commas != 2 || !trimmed(c, n, part, sizeof part))
            BRC_FAIL(
                ctx, BRC_ERR_INPUT,
                "%s: '%.60s' must be three values between commas, as in %s; numbers have a decimal "
                "point",
                place, text, p->default_text ? p->default_text : "'1, 2, 3'");
        if (p->kind == BRC_REAL3)
            BRC_TRY(set_real(ctx, p, &real[i], part, place));
        else
            BRC_TRY(set_int(ctx, p, &whole[i], part, place));
        c += n + 1;
    }
    if (p->kind == BRC_REAL3)
        memcpy(to, real, sizeof real);
    else
        memcpy(to, whole, sizeof whole);
    return 0;
}

static int set_value(struct brc_context *ctx, const struct brc_param *p, void *values,
                     const char *text, const char *place)
{
    void *to = (char *)values + p->offset;
    switch (p->kind) {
    case BRC_REAL:
        return set_real(ctx, p, to, text, place);
    case BRC_INT:
        return set_int(ctx, p, to, text, place);
    case BRC_CHOICE:
        return set_choice(ctx, p, to, text, place);
    case BRC_FLAG:
        return set_flag(ctx, to, text, place);
    case BRC_TEXT:
        return set_text(ctx, to, text, place);
    case BRC_REAL3:
    case BRC_INT3:
        return set_triple(ctx, p, to, text, place);
    }
    BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: unknown kind of parameter", place);
}

/* ---- lists --------------------------------------------------------------------------------- */

/* "file.yaml:12: vgcm.e_bar" */
static void make_place(char place[PLACE_SIZE], const char *where, const char *section,
                       const char *key)
{
    snprintf(place, PLACE_SIZE, "%.200s: %.50s%s%.60s", where, section, *section ? "." : "", key);
}

int brc_params_defaults(struct brc_context *ctx, struct brc_param_list list, void *values)
{
    char place[PLACE_SIZE];
    memset(values, 0, list.owner_size);
    for (int i = 0; i < list.n; i++) {
        const struct brc_param *p = &list.params[i];
        make_place(place, "default", "", p->key);
        if (p->default_text)
            BRC_TRY(set_value(ctx, p, values, p->default_text, place));
    }
    return 0;
}

const struct brc_param *brc_params_find(struct brc_param_list list, const char *key)
{
    for (int i = 0; i < list.n; i++)
        if (strcmp(list.params[i].key, key) == 0)
            return &list.params[i];
    return NULL;
}

const struct brc_param *brc_params_renamed(struct brc_param_list list, const char *key)
{
    for (int i = 0; i < list.n; i++)
        if (list.params[i].renamed && strcmp(list.params[i].renamed, key) == 0)
            return &list.params[i];
    return NULL;
}

/* What is allowed, where the message does not say it yet. */
static void add_range(struct brc_context *ctx, const struct brc_param *p)
{
    size_t used = strlen(ctx->message);
    if (p->range && !strstr(ctx->message, "allowed"))
        snprintf(ctx->message + used, sizeof ctx->message - used, "; allowed %s%s%s%s", p->range,
                 strcmp(p->unit, "1") == 0 ? "" : " ", strcmp(p->unit, "1") == 0 ? "" : p->unit,
                 is_auto(p) ? ", or " BRC_AUTO : "");
}

int brc_params_set(struct brc_context *ctx, struct brc_param_list list, void *values,
                   const char *section, const char *key, const char *text, const char *where)
{
    char place[PLACE_SIZE], keys[BRC_NAMES_SIZE] = "", hint[BRC_HINT_SIZE];
    const struct brc_param *p = brc_params_find(list, key);
    make_place(place, where, section, key);
    if (p) {
        int code = set_value(ctx, p, values, text, place);
        if (code == BRC_ERR_INPUT)
            add_range(ctx, p);
        return code;
    }
    const struct brc_param *meant =
        *brc_params_hint(list, key, hint) ? NULL : brc_params_meant(list, key);
    for (int i = 0; i < list.n; i++)
        brc_names_add(keys, sizeof keys, list.params[i].key);
    if (meant)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: unknown key; did you mean '%s' (%s)? allowed %s", place,
                 meant->key, meant->meaning, keys);
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: unknown key; allowed %s%s", place, keys, hint);
}

/* ---- text and reference -------------------------------------------------------------------- */

/* Shortest text that reads back as the same double, in the unit of the default, else in SI. */
static int real_text(const struct brc_param *p, double value, char *buffer, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    const char *unit = "";
    double factor = 1;
    bool is_pure = strcmp(p->unit, "1") == 0;
    char number[64];
    if (is_auto(p) && isnan(value))
        return snprintf(buffer, size, BRC_AUTO);
    if (p->default_text && !is_auto(p))
        split_quantity(p->default_text, &unit);
    size_t n = strcspn(unit, ","); /* of three, the first one's */
    char own[64];
    if (n == 0 || !trimmed(unit, n, own, sizeof own) ||
        brc_units_factor(&ctx, own, p->unit, p->key, &factor) != 0)
        snprintf(own, sizeof own, "%s", is_pure ? "" : p->unit);
    for (int precision = 6; precision <= 17; precision++) {
        snprintf(number, sizeof number, "%.*g", precision, value / factor);
        if (scaled_number(number, strlen(number), factor) == value)
            return snprintf(buffer, size, "%s%s%s", number, *own ? " " : "", own);
    }
    return snprintf(buffer, size, "%.17g%s%s", value, is_pure ? "" : " ", is_pure ? "" : p->unit);
}

static void triple_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    size_t used = 0;
    for (int i = 0; i < 3 && used < size; i++) {
        int n = i ? snprintf(buffer + used, size - used, ", ") : 0;
        used += (size_t)n;
        if (used >= size)
            return;
        if (p->kind == BRC_REAL3)
            n = real_text(p, ((const double *)from)[i], buffer + used, size - used);
        else
            n = snprintf(buffer + used, size - used, "%d", ((const int *)from)[i]);
        used += (size_t)n;
    }
}

const char *brc_params_text(const struct brc_param *p, const void *values, char *buffer,
                            size_t size)
{
    const void *from = (const char *)values + p->offset;
    switch (p->kind) {
    case BRC_REAL:
        real_text(p, *(const double *)from, buffer, size);
        break;
    case BRC_INT:
        snprintf(buffer, size, "%d", *(const int *)from);
        break;
    case BRC_CHOICE:
    case BRC_FLAG:
        return brc_params_choice(p, values, buffer, size);
    case BRC_TEXT:
        snprintf(buffer, size, "%s", (const char *)from);
        break;
    case BRC_REAL3:
    case BRC_INT3:
        triple_text(p, from, buffer, size);
        break;
    }
    return buffer;
}

const char *brc_params_choice(const struct brc_param *p, const void *values, char *buffer,
                              size_t size)
{
    int k = *(const int *)((const char *)values + p->offset);
    if (k < 0 || !choice_name(p->choices, k, buffer, size))
        snprintf(buffer, size, "?");
    return buffer;
}

/* ---- checks of a declaration --------------------------------------------------------------- */

static size_t kind_size(enum brc_param_kind kind)
{
    switch (kind) {
    case BRC_REAL:
        return sizeof(double);
    case BRC_INT:
    case BRC_CHOICE:
    case BRC_FLAG:
        return sizeof(int);
    case BRC_TEXT:
        return BRC_TEXT_SIZE;
    case BRC_REAL3:
        return 3 * sizeof(double);
    case BRC_INT3:
        return 3 * sizeof(int);
    }
    return SIZE_MAX;
}

/* The declaration alone, without its default. */
static int check_declaration(struct brc_context *ctx, struct brc_param_list list, int i,
                             const char *place)
{
    const struct brc_param *p = &list.params[i];
    struct interval r;
    double factor;
    if (*p->key == '\0' ||
        strspn(p->key, "abcdefghijklmnopqrstuvwxyz0123456789_") != strlen(p->key))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the key is not in snake case", place);
    if (brc_params_find(list, p->key) != p)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the key is declared twice", place);
    if (p->renamed && brc_params_find(list, p->renamed))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the older name '%s' is a key", place, p->renamed);
    if ((p->flags & BRC_PARAM_FILE && p->kind != BRC_TEXT) ||
        (p->flags & BRC_PARAM_AXIS && p->kind != BRC_CHOICE && p->kind != BRC_FLAG))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the flags do not fit the kind", place);
    if (!p->meaning || !*p->meaning)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the meaning is missing", place);
    if (p->offset + kind_size(p->kind) > list.owner_size)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the member lies outside its struct", place);
    if (p->range && !parse_interval(p->range, &r))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the range '%s' is not an interval", place, p->range);
    if ((p->kind == BRC_CHOICE || p->kind == BRC_FLAG) && (!p->choices || !*p->choices))
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the choices are missing", place);
    return brc_units_factor(ctx, p->unit, p->unit, place, &factor);
}

/* Default in range, and the same bits after writing and reading. */
static int check_default(struct brc_context *ctx, const struct brc_param *p, void *values,
                         void *again, const char *place)
{
    char text[BRC_TEXT_SIZE];
    BRC_TRY(set_value(ctx, p, values, p->default_text, place));
    brc_params_text(p, values, text, sizeof text);
    BRC_TRY(set_value(ctx, p, again, text, place));
    if (memcmp((char *)values + p->offset, (char *)again + p->offset, kind_size(p->kind)) != 0)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: the default '%s' is written as '%s', which differs",
                 place, p->default_text, text);
    return 0;
}

int brc_params_check_list(struct brc_context *ctx, const char *title, struct brc_param_list list)
{
    char place[PLACE_SIZE];
    char *values = brc_alloc(ctx, 2, list.owner_size);
    int code = values ? 0 : BRC_ERR_MEMORY;
    for (int i = 0; i < list.n && code == 0; i++) {
        const struct brc_param *p = &list.params[i];
        make_place(place, "declaration", title, p->key);
        code = check_declaration(ctx, list, i, place);
        if (code == 0 && p->default_text)
            code = check_default(ctx, p, values, values + list.owner_size, place);
    }
    free(values);
    return code;
}
