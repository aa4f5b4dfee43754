/* SPDX-License-Identifier: GPL-3.0-or-later */
/* UDUNITS-2 accepts more than a case should: reciprocals, offsets, numbers in odd places and angles
 * as pure numbers. Each is a likely slip in a case, so each is refused here. Called by params.c for
 * every quantity; knows no key and no range. */
#include "common/input/units.h"

#include <udunits2.h>

#include <ctype.h>
#include <math.h>
#include <string.h>

/* Lives until the program ends: reading the data base takes longer than reading a case. */
static ut_system *unit_system;

/* Reads the unit data base once; degrees get the short name that rock mechanics uses. Messages of
 * the library itself are off: they go to standard error, without the place in the case. */
static int system_open(struct brc_context *ctx)
{
    if (unit_system)
        return 0;
    ut_set_error_message_handler(ut_ignore);
    unit_system = ut_read_xml(NULL);
    if (!unit_system)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "cannot read the UDUNITS-2 data base; install libudunits2-data, or set "
                 "UDUNITS2_XML_PATH to udunits2.xml");
    ut_unit *degree = ut_parse(unit_system, "arc_degree", UT_UTF8);
    if (degree) {
        ut_map_name_to_unit("deg", UT_ASCII, degree);
        ut_free(degree);
    }
    return 0;
}

/* UDUNITS reads "m 3" as 3 m and "m^0.5" as 5: a digit may only be an exponent or the 1 of "1/s".
 */
static bool has_stray_number(const char *text)
{
    for (const char *c = text; *c; c++) {
        if (!isdigit((unsigned char)*c) || (c == text && c[1] == '/' && *c == '1'))
            continue;
        if (c == text || (!isalnum((unsigned char)c[-1]) && !strchr("^-+", c[-1])))
            return true;
    }
    return strchr(text, '@') != NULL;
}

/* UDUNITS has no word for the unit of a pure number, so that "1" is taken out before. */
static ut_unit *unit_parse(const char *text)
{
    if (strcmp(text, "1") == 0)
        return ut_get_dimensionless_unit_one(unit_system);
    return has_stray_number(text) ? NULL : ut_parse(unit_system, text, UT_UTF8);
}

/* Same dimension, the reciprocal excluded: ut_are_convertible alone would take s for 1/s. */
static bool is_same_dimension(const ut_unit *a, const ut_unit *b)
{
    ut_unit *ratio = ut_divide(a, b);
    bool same = ratio && ut_is_dimensionless(ratio) && ut_are_convertible(a, b);
    ut_free(ratio);
    return same;
}

/* A unit in SI base units, "" where it has no such form. */
static const char *definition(const ut_unit *unit, char text[128])
{
    int n = ut_format(unit, text, 128, UT_DEFINITION | UT_ASCII);
    return n > 0 && n < 128 ? text : "";
}

/* Radians count as dimensionless in UDUNITS; here a pure number is no angle, and the reverse. */
static bool is_angle(const ut_unit *unit)
{
    char text[128];
    return strstr(definition(unit, text), "rad") != NULL;
}

/* False when the conversion is more than a factor: of degC the zero is elsewhere, of a decibel the
 * factor depends on the value. */
static bool get_factor(ut_unit *from, ut_unit *to, double *factor)
{
    cv_converter *converter = ut_get_converter(from, to);
    if (!converter)
        return false;
    bool is_linear = cv_convert_double(converter, 0.0) == 0.0;
    *factor = cv_convert_double(converter, 1.0);
    cv_free(converter);
    return is_linear && isfinite(*factor) && *factor > 0;
}

/* The dimension is checked before the factor: of a wrong unit one wants to hear what it is, not
 * that it cannot be converted. */
static int factor_between(struct brc_context *ctx, ut_unit *a, ut_unit *b, const char *from,
                          const char *to, const char *where, double *factor)
{
    if (!a)
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: '%.60s' is not a unit; expected a unit of the dimension of %s (capitals "
                 "matter: MPa, mm, kg)",
                 where, from, to);
    if (!is_same_dimension(a, b) || is_angle(a) != is_angle(b)) {
        char text[128];
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: the unit '%.60s' has the wrong dimension (it is %s); expected a unit of the "
                 "dimension of %s",
                 where, from, *definition(a, text) ? text : "no plain unit", to);
    }
    if (!get_factor(a, b, factor))
        BRC_FAIL(ctx, BRC_ERR_INPUT,
                 "%s: the unit '%.60s' is not a plain multiple of %s (offsets and dates are not "
                 "accepted)",
                 where, from, to);
    return 0;
}

int brc_units_factor(struct brc_context *ctx, const char *from, const char *to, const char *where,
                     double *factor)
{
    BRC_TRY(system_open(ctx));
    ut_unit *b = unit_parse(to);
    if (!b)
        BRC_FAIL(ctx, BRC_ERR_INTERNAL, "%s: '%s' is declared as a unit but is none", where, to);
    ut_unit *a = unit_parse(from);
    int code = factor_between(ctx, a, b, from, to, where, factor);
    ut_free(a);
    ut_free(b);
    return code;
}
