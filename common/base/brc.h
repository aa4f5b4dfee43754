/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Basic types, version and forward declarations. Includes nothing but the standard integer, size
 * and bool headers, since every file of breccia includes it. All quantities are SI; only the case
 * reader knows of other units. */
#ifndef BRC_BRC_H
#define BRC_BRC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define BRC_VERSION "0.1.0"
#define BRC_PI      3.14159265358979323846 /* M_PI is not of standard C */

/* An option that a scene may leave off. `make bench` builds the library once more with BRC_BARE, in
 * which options are off as it is compiled, to measure what they cost when they are off as it runs.
 */
#ifdef BRC_BARE
#define BRC_OPTION(is_on) ((void)(is_on), false)
#else
#define BRC_OPTION(is_on) (is_on)
#endif

struct brc_context;  /* errors, log, ranks: error.h */
struct brc_table;    /* arrays declared by a field list: table.h */
struct brc_facets;   /* tessellation result: facets.h */
struct brc_specimen; /* grains' geometry before any model: specimen.h */
struct brc_contacts; /* contact arrays: contacts.h */
struct brc_model;    /* operations table of a contact model: model.h */
struct brc_sim;      /* one running simulation: sim.h */

#endif
