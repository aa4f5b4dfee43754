/* SPDX-License-Identifier: GPL-3.0-or-later */
/* YAML as this program takes it: UTF-8 without control characters, one document that is a mapping,
 * without anchors, aliases and tags, which are YAML's way to programs, while a case or a sweep is
 * data that people read. For the readers of this folder, which walk through the document. */
#ifndef BRC_CASEFILE_YAML_H
#define BRC_CASEFILE_YAML_H

#include "common/base/error.h"

struct yaml_document_s; /* libyaml's yaml_document_t */

/* What is read: for messages, path and what it is ("case file"). */
struct brc_yaml_text {
    const char *path, *noun, *text;
    size_t size; /* bytes */
};

/* Calls act for the document of the text; an empty text has none, which is no failure. Whatever is
 * not taken is BRC_ERR_INPUT with file and line. */
int brc_yaml_load(struct brc_context *ctx, const struct brc_yaml_text *from,
                  int (*act)(void *user, struct yaml_document_s *document), void *user);

#endif
