/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which key was meant by one that is not in a list. */
#include "common/input/params.h"

#include <ctype.h>
#include <string.h>

enum { LEAST_WORD = 4 };

const char *brc_params_hint(struct brc_param_list list, const char *key, char hint[BRC_HINT_SIZE])
{
    struct brc_nearest nearest = {.text = key};
    for (int i = 0; i < list.n; i++)
        brc_nearest_add(&nearest, list.params[i].key);
    return brc_nearest_hint(&nearest, hint);
}

/* Is the word in the text, without regard to case? */
static bool holds_word(const char *text, const char *word, size_t n)
{
    for (; *text; text++) {
        size_t i = 0;
        while (i < n && tolower((unsigned char)text[i]) == tolower((unsigned char)word[i]))
            i++;
        if (i == n)
            return true;
    }
    return false;
}

const struct brc_param *brc_params_meant(struct brc_param_list list, const char *key)
{
    const struct brc_param *best = NULL;
    size_t most = 0;
    for (int k = 0; k < list.n; k++) {
        size_t found = 0;
        for (const char *word = key; *word;) {
            size_t n = strcspn(word, "_");
            if (n >= LEAST_WORD && holds_word(list.params[k].meaning, word, n))
                found += n;
            word += n + (word[n] == '_');
        }
        if (found > most) {
            most = found;
            best = &list.params[k];
        }
    }
    return best;
}
