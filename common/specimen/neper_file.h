/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a tessellation file of Neper holds, as it stands there: between the parser, which knows
 * words and no geometry, and the reader, which knows geometry and no words. Lengths are those of
 * the file. */
#ifndef BRC_NEPER_FILE_H
#define BRC_NEPER_FILE_H

#include "common/base/pool.h"

enum { BRC_NEPER_TOKEN = 128 };

struct brc_neper_face {
    int32_t cell[2]; /* -1: none */
    int32_t domain;  /* face of the domain, -1: inside */
    size_t first;    /* in loop */
    int32_t n;
};

struct brc_neper_file {
    struct brc_context *ctx;
    const char *path;
    char *text; /* of size bytes, ends with a zero behind them */
    size_t size;
    const char *at; /* the parser's place, its line, and the word that it has read last */
    int line;
    char token[BRC_NEPER_TOKEN];
    bool is_format_2; /* 2.0: faces of the domain are given by their equations */
    size_t n_cells;   /* those that have no faces included */
    size_t n_vertices, n_faces, n_domain, n_loop;
    double (*seed)[4]; /* with weight; 0 where the file has none */
    bool has_seeds;
    double (*vertex)[3];
    struct brc_neper_face *face;
    int32_t *loop;
    uint8_t *is_curved;   /* [n_domain] the face of the domain is said to be no plane */
    int digits;           /* most significant digits of a vertex's coordinate */
    struct brc_pool pool; /* owns the arrays but for the text */
};

/* Reads the text into the arrays. */
int brc_neper_parse(struct brc_neper_file *t);

#endif
