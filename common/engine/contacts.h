/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact arrays shared by all models: one row a pair of bodies that are bonded, touch, or are near
 * enough to be watched, always sorted by (a, b), a < b. Grain pairs and grain-platen pairs are two
 * such sets of the same form (a platen is a body, so b is its body number). Points are the places
 * where a pair interacts, several a contact, in a range of their own. */
#ifndef BRC_CONTACTS_H
#define BRC_CONTACTS_H

#include "common/base/table.h"
#include "common/geometry/grid.h"

enum brc_status {
    BRC_OPEN,   /* never bonded: touches, or is watched */
    BRC_INTACT, /* bonded */
    BRC_BROKEN  /* was bonded; interacts by collision and friction */
};

/* n points from a to b. k is written by the model whenever a contact's stiffness changes. */
#define BRC_CONTACT_FIELDS(SCALAR, VECTOR)                                                    \
    SCALAR(int32_t, a, BRC_STATE, "1", "body with the lower number")                          \
    SCALAR(int32_t, b, BRC_STATE, "1", "body with the higher number")                         \
    SCALAR(int32_t, facet, BRC_STATE, "1", "facet of the specimen, -1 when there is none")    \
    SCALAR(uint8_t, status, BRC_STATE, "1", "0 open, 1 intact bond, 2 broken bond")           \
    SCALAR(int32_t, p0, BRC_SCRATCH, "1", "first point")                                      \
    SCALAR(int32_t, np, BRC_STATE, "1", "number of points")                                   \
    SCALAR(int32_t, pcap, BRC_SCRATCH, "1", "points reserved")                                \
    VECTOR(double, f, 3, BRC_STATE, "N", "force on b; a gets the opposite")                   \
    VECTOR(double, ta, 3, BRC_STATE, "N m", "moment on a about its centre")                   \
    VECTOR(double, tb, 3, BRC_STATE, "N m", "moment on b about its centre")                   \
    VECTOR(double, k, 3, BRC_STATE, "N m-1, N m, N m",                                        \
           "sum over active springs of max(kn, ks), and of that times |r|^2 for a and for b") \
    SCALAR(double, gap, BRC_STATE, "m", "smallest distance of the surfaces, negative in overlap")

struct brc_contacts {
    BRC_CONTACT_FIELDS(BRC_COLUMN, BRC_COLUMN3)
    size_t n;
    int32_t lanes; /* ranges of points begin at multiples of it, and are padded to one */
    struct brc_table table;
    struct brc_table model; /* the model's contact fields, same rows */
    void *model_columns;
    struct brc_table points; /* the model's point fields; rows p0 .. p0 + np of each contact */
    void *point_columns;
    int64_t
        k_version; /* counts changes of any k, and of the set of rows; the model bumps it, too */
    /* rows of each body, ascending: row * 2 + (1 where the body is b) */
    size_t n_bodies;
    size_t *adjacent_first; /* [n_bodies + 1] */
    uint32_t *adjacent;
};

/* name: "pairs" or "platens". */
int brc_contacts_create(struct brc_context *ctx, struct brc_contacts *c, const char *name,
                        size_t n_bodies, struct brc_fieldset model, struct brc_fieldset points);
void brc_contacts_free(struct brc_contacts *c);

/* The row set becomes exactly the given sorted pairs: rows that exist keep all their state and
 * points, new ones are zero (status BRC_OPEN, no points) with facet -1. */
int brc_contacts_set(struct brc_context *ctx, struct brc_contacts *c, const int32_t (*pair)[2],
                     size_t n);
/* Whether a pair is a contact after a neighbour search: one that is there has a row, else -1. */
typedef bool brc_contacts_stays(const void *user, const struct brc_contacts *c,
                                const int32_t pair[2], int64_t row, bool is_near);
/* brc_contacts_set to those of the contacts and neighbours that stay. The order of rows follows
 * from the numbers of their bodies alone, never from when they were found. */
int brc_contacts_merge(struct brc_context *ctx, struct brc_contacts *c,
                       const struct brc_neighbours *near, brc_contacts_stays *stays,
                       const void *user);
struct brc_facing;
/* brc_contacts_set to the pairs of bodies of facets (platens.h) that are sorted by these; facets of
 * one pair make one contact. Specimens have their facets in this order. */
int brc_contacts_open(struct brc_context *ctx, struct brc_contacts *c,
                      const struct brc_facing *facet, size_t n);
/* Room for np points on row i; existing points are kept (they may move, all columns may move), new
 * ones are zero. */
int brc_contacts_points(struct brc_context *ctx, struct brc_contacts *c, size_t i, int32_t np);
/* Row of the pair, or -1. */
int64_t brc_contacts_find(const struct brc_contacts *c, int32_t a, int32_t b);
/* Closes gaps between the point ranges: what lies between them are zeros up to the next multiple of
 * lanes. With 1 p0 is the running sum of np, as files have it. */
int brc_contacts_pack(struct brc_context *ctx, struct brc_contacts *c, int32_t lanes);
/* The same with the lanes of the model. */
int brc_contacts_compact(struct brc_context *ctx, struct brc_contacts *c);
/* Compacts when a fifth of the points' memory has been left behind by ranges that moved. */
int brc_contacts_tidy(struct brc_context *ctx, struct brc_contacts *c);
/* After the tables have been replaced by saved, packed ones: n, p0 and the rows of each body. */
int brc_contacts_restore(struct brc_context *ctx, struct brc_contacts *c);
/* Hash of rows and points, independent of how the ranges lie in memory. */
uint64_t brc_contacts_hash(const struct brc_contacts *c, uint64_t seed);

#endif
