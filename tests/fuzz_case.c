/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/fuzz.h"

#include "common/runs/case.h"
#include "tests/fuzz_aid.h"

#include <stdlib.h>
#include <string.h>

/* The assignments behind the case's text. */
static int override(struct brc_context *ctx, struct brc_casefile *c, const char *text, size_t left)
{
    while (left > 0) {
        size_t n = strlen(text); /* the copy ends with a NUL */
        int code = brc_casefile_override(ctx, c, text);
        if (code != 0)
            return code;
        if (n + 1 >= left)
            break;
        text += n + 1;
        left -= n + 1;
    }
    return 0;
}

static int judge_section(struct brc_context *ctx, const struct brc_casefile *c, const char *name,
                         struct brc_param_list list)
{
    void *values = calloc(1, list.owner_size + 1), *again = calloc(1, list.owner_size + 1);
    FUZZ_MUST(values && again);
    int code = brc_casefile_section(ctx, c, name, list, values);
    if (code == 0)
        FUZZ_MUST(brc_casefile_section(ctx, c, name, list, again) == 0);
    /* what has been read prints, and what is printed reads back */
    for (int i = 0; code == 0 && i < list.n; i++) {
        char text[2 * BRC_TEXT_SIZE];
        brc_params_text(&list.params[i], values, text, sizeof text);
        if (list.params[i].kind != BRC_TEXT)
            FUZZ_MUST(brc_params_set(ctx, list, again, name, list.params[i].key, text, "again") ==
                      0);
    }
    if (code == 0)
        FUZZ_MUST(memcmp(values, again, list.owner_size) == 0);
    free(values);
    free(again);
    return code;
}

static int judge(struct brc_context *ctx, const struct brc_casefile *c)
{
    const char *names[64];
    struct brc_case_section s;
    size_t n = 0;
    for (; n < 64 && brc_case_section(NULL, (int)n, &s); n++) {
        names[n] = s.name;
        int code = judge_section(ctx, c, s.name, s.list);
        if (code != 0)
            return code;
    }
    return brc_casefile_finish(ctx, c, names, n);
}

int fuzz_case(const uint8_t *data, size_t size)
{
    struct brc_context ctx = BRC_CONTEXT_INIT;
    struct brc_casefile c;
    char *text = malloc(size + 1);
    FUZZ_MUST(text != NULL);
    if (size > 0)
        memcpy(text, data, size);
    text[size] = '\0';
    size_t n = strlen(text);
    int code = brc_casefile_parse(&ctx, "fuzz.yaml", text, n, &c);
    if (code == 0 && n < size)
        code = override(&ctx, &c, text + n + 1, size - n);
    if (code == 0)
        code = judge(&ctx, &c);
    fuzz_check_record(&ctx, code);
    brc_casefile_free(&c);
    free(text);
    return 0;
}
