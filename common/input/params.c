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

/* An interval such as "(0, inf)". Open bounds are needed: a stiffness of 0 is no stiffness, a
 * strain of 0 may be one. */
struct interval {
    double low, high;
    bool low_open, high_open;
};

/* ---- numbers ------------------------------------------------------------------------------- */

/* Length of the decimal number that text starts with, 0 when there is none. Hexadecimal, inf and
 * nan, which strtod takes, are not numbers here: in a case they are slips or mischief. */
static size_t number_length(const char *text)
{
    char *end;
    (void)strtod(text, &end);
    size_t n = (size_t)(end - text);
    return strspn(text, "+-.0123456789eE") >= n ? n : 0;
}

/* number times factor; powers of ten move the decimal exponent, so that "5.1 mm" and "0.0051 m" are
 * the same double. Other factors (degrees, inches, hours) are not exact in binary anyway: there one
 * multiplication is as good as any text. */
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
    if (exponent > 9999 || exponent < -9999) /* inf or 0 whatever the factor; refused by callers */
        return strtod(text, NULL);
    snprintf(e ? e : text + length, 32, "e%ld", exponent + k);
    return strtod(text, NULL);
}

/* Text without the blanks at its ends, in buffer; NULL when it does not fit, so that nothing is cut
 * in silence and then read as another value. */
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

/* What is refused has a message of its own where the slip is a known one: a decimal comma, a
 * missing unit, no number. A number without a unit is never taken for SI: in a case that gives mm
 * elsewhere it is as likely to be mm. */
int brc_params_quantity(struct brc_context *ctx, const char *text, const char *unit, double *value,
                        const char *where)
{
    char clean[BRC_TEXT_SIZE];
    const char *own;
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
                 where, clean, brc_unit_blank(unit), brc_unit_shown(unit));
    if (*own == '\0' && *brc_unit_shown(unit) != '\0')
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' has no unit; expected a unit of the dimension of %s, for example "
                 "'%.60s %s'",
                 where, clean, unit, clean, unit);
    if (*own != '\0')
        BRC_TRY(brc_units_factor(ctx, own, unit, where, &factor));
    double result = scaled_number(clean, length, factor);
    if (!isfinite(result))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is too large for a number", where, clean);
    /* a 0 that was not written as one */
    size_t first_digit = strcspn(clean, "123456789");
    if (result == 0 && first_digit < length && first_digit < strcspn(clean, "eE"))
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is too small for a number", where, clean);
    *value = result;
    return 0;
}

/* ---- intervals ----------------------------------------------------------------------------- */

/* "(0, inf)", "[0, 1]": a round bracket leaves the bound out. */
static bool parse_interval(const char *text, struct interval *r)
{
    char low, high;
    int n = 0;
    if (sscanf(text, "%c%lf,%lf%c%n", &low, &r->low, &r->high, &high, &n) != 4 || text[n] != '\0')
        return false;
    r->low_open = low == '(';
    r->high_open = high == ')';
    return (r->low_open || low == '[') && (r->high_open || high == ']') && r->low <= r->high;
}

/* In SI, after the conversion: ranges are declared once, units are the user's choice. */
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
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %.60s is out of range", place, text);
}

/* ---- one value of each kind ---------------------------------------------------------------- */

/* A default that is found later, from what else is known; NAN until then, so that a use before that
 * shows in all that follows. */
static bool is_auto(const struct brc_param *p)
{
    return p->kind == BRC_REAL && p->default_text && strcmp(p->default_text, BRC_AUTO) == 0;
}

static int set_real(struct brc_context *ctx, const struct brc_param *p, void *to, const char *text,
                    const char *place)
{
    double *value = to;
    *value = NAN;
    if (is_auto(p) && strcmp(text, BRC_AUTO) == 0)
        return 0;
    BRC_TRY(brc_params_quantity(ctx, text, p->unit, value, place));
    return check_range(ctx, p, *value, text, place);
}

/* strtoll also takes what is no int, so that too large a number is told from what is no number. */
static int set_int(struct brc_context *ctx, const struct brc_param *p, void *to, const char *text,
                   const char *place)
{
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    while (isspace((unsigned char)*end))
        end++;
    if (end == text || *end != '\0')
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is not a whole number, written in digits", place,
                 text);
    if (errno == ERANGE || value > INT_MAX || value < INT_MIN)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: %.60s is out of range", place, text);
    *(int *)to = (int)value;
    return check_range(ctx, p, (double)value, text, place);
}

/* Name k of a |-separated list in buffer; false past the last. The list is one text, as declared
 * and as shown: an array of names would have to be declared apart from the row of the key. */
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

/* By the exact name. Numbers of choices are not taken: they would change when a choice is added
 * between others. */
static int set_choice(struct brc_context *ctx, const struct brc_param *p, void *to,
                      const char *text, const char *place)
{
    char name[BRC_NAME_SIZE], hint[BRC_HINT_SIZE];
    struct brc_nearest nearest = {.text = text};
    for (int k = 0; choice_name(p->choices, k, name, sizeof name); k++) {
        if (strcmp(name, text) == 0) {
            *(int *)to = k;
            return 0;
        }
        brc_nearest_add(&nearest, name);
    }
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is not a choice; allowed %.300s%s", place, text,
             p->choices, brc_nearest_hint(&nearest, hint));
}

/* More words than on and off: YAML 1.1 takes all of these for flags. */
static int set_flag(struct brc_context *ctx, const struct brc_param *p, void *to, const char *text,
                    const char *place)
{
    (void)p;
    static const char *const words[] = {"off", "on", "false", "true", "no", "yes"};
    for (int k = 0; k < 6; k++)
        if (strcasecmp(text, words[k]) == 0) {
            *(int *)to = k % 2;
            return 0;
        }
    BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: '%.60s' is not a flag; allowed on, off, true, false, yes, no",
             place, text);
}

/* Zeroed behind its end, so that structs of parameters can be compared as bytes. */
static int set_text(struct brc_context *ctx, const struct brc_param *p, void *to, const char *text,
                    const char *place)
{
    (void)p;
    if (strlen(text) >= BRC_TEXT_SIZE)
        BRC_FAIL(ctx, BRC_ERR_INPUT, "%s: the text has %zu bytes; allowed at most %d", place,
                 strlen(text), BRC_TEXT_SIZE - 1);
    memset(to, 0, BRC_TEXT_SIZE);
    strcpy(to, text);
    return 0;
}

/* Three parts between commas; the commas are counted first, since "1,5, 2, 3" with decimal commas
 * would otherwise be three good values of four. */
static int set_triple(struct brc_context *ctx, const struct brc_param *p, void *to,
                      const char *text, const char *place)
{
    char part[BRC_TEXT_SIZE];
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
        BRC_TRY(p->kind == BRC_REAL3 ? set_real(ctx, p, (double *)to + i, part, place)
                                     : set_int(ctx, p, (int *)to + i, part, place));
        c += n + 1;
    }
    return 0;
}

/* Shortest text that reads back as the same double, in the unit of the default, else in SI: a kept
 * case is read by people, and must make the same run. */
static void real_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    double value = *(const double *)from, factor = 1;
    const char *unit = "";
    char own[64], number[64];
    if (is_auto(p) && isnan(value)) {
        snprintf(buffer, size, BRC_AUTO);
        return;
    }
    if (p->default_text && !is_auto(p))
        split_quantity(p->default_text, &unit);
    size_t n = strcspn(unit, ","); /* of three, the first one's */
    if (n == 0 || !trimmed(unit, n, own, sizeof own) ||
        brc_units_factor(&ctx, own, p->unit, p->key, &factor) != 0)
        snprintf(own, sizeof own, "%s", brc_unit_shown(p->unit));
    for (int precision = 6; precision <= 17; precision++) {
        snprintf(number, sizeof number, "%.*g", precision, value / factor);
        if (scaled_number(number, strlen(number), factor) == value) {
            snprintf(buffer, size, "%s%s%s", number, *own ? " " : "", own);
            return;
        }
    }
    snprintf(buffer, size, "%.17g%s%s", value, brc_unit_blank(p->unit), brc_unit_shown(p->unit));
}

static void int_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    (void)p;
    snprintf(buffer, size, "%d", *(const int *)from);
}

static void choice_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    int k = *(const int *)from;
    if (k < 0 || !choice_name(p->choices, k, buffer, size))
        snprintf(buffer, size, "?");
}

static void plain_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    (void)p;
    snprintf(buffer, size, "%s", (const char *)from);
}

static void triple_text(const struct brc_param *p, const void *from, char *buffer, size_t size)
{
    char part[3][BRC_NAME_SIZE];
    for (int i = 0; i < 3; i++) {
        if (p->kind == BRC_REAL3)
            real_text(p, (const double *)from + i, part[i], sizeof part[i]);
        else
            int_text(p, (const int *)from + i, part[i], sizeof part[i]);
    }
    snprintf(buffer, size, "%s, %s, %s", part[0], part[1], part[2]);
}

/* What can be done with a value, by its kind: a new kind is one row here and its macros in
 * params.h. */
static const struct kind {
    size_t size; /* of the member */
    int (*set)(struct brc_context *ctx, const struct brc_param *p, void *to, const char *text,
               const char *place);
    void (*text)(const struct brc_param *p, const void *from, char *buffer, size_t size);
} kinds[] = {
    [BRC_REAL] = {sizeof(double), set_real, real_text},
    [BRC_INT] = {sizeof(int), set_int, int_text},
    [BRC_CHOICE] = {sizeof(int), set_choice, choice_text},
    [BRC_FLAG] = {sizeof(int), set_flag, choice_text},
    [BRC_TEXT] = {BRC_TEXT_SIZE, set_text, plain_text},
    [BRC_REAL3] = {3 * sizeof(double), set_triple, triple_text},
    [BRC_INT3] = {3 * sizeof(int), set_triple, triple_text},
};

/* By way of a value apart: one that is refused leaves the owner as it was, and no kind has to care.
 */
static int set_value(struct brc_context *ctx, const struct brc_param *p, void *values,
                     const char *text, const char *place)
{
    union {
        double real[3];
        int whole[3];
        char text[BRC_TEXT_SIZE];
    } value;
    BRC_TRY(kinds[p->kind].set(ctx, p, &value, text, place));
    memcpy((char *)values + p->offset, &value, kinds[p->kind].size);
    return 0;
}

const char *brc_params_text(const struct brc_param *p, const void *values, char *buffer,
                            size_t size)
{
    kinds[p->kind].text(p, (const char *)values + p->offset, buffer, size);
    return buffer;
}

/* ---- lists --------------------------------------------------------------------------------- */

/* "file.yaml:12: vgcm.e_bar": how every message about a value begins. Parts are cut rather than the
 * end, which has the key. */
static void make_place(char place[PLACE_SIZE], const char *where, const char *section,
                       const char *key)
{
    snprintf(place, PLACE_SIZE, "%.200s: %.50s%s%.60s", where, section, *section ? "." : "", key);
}

/* Defaults go through the same reader as values: they are texts with units, and one that is out of
 * its range is found by the first test. */
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

/* What is allowed, here alone, so that every message about a number ends in its range; what has no
 * range says itself what it takes. It is lengthened, as the first failure is the one that stays. */
static void add_range(struct brc_context *ctx, const struct brc_param *p)
{
    size_t used = strlen(ctx->message);
    if (p->range)
        snprintf(ctx->message + used, sizeof ctx->message - used, "; allowed %s%s%s%s", p->range,
                 brc_unit_blank(p->unit), brc_unit_shown(p->unit),
                 is_auto(p) ? ", or " BRC_AUTO : "");
}

/* An unknown key is an error and never passed over: a slip in a name would leave the default in
 * use. The message lists all keys, with the nearest, or else the one whose meaning has the words.
 */
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
