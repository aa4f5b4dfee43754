/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which key was meant by one that is not in a list: by its spelling, or by its words, which may
 * stand in the meaning of a key that is called otherwise. For messages alone: nothing is ever read
 * under a name that was guessed. */
#include "common/input/params.h"

#include <strings.h>

/* Letters: shorter words (of, dt, max) stand in many meanings. */
enum { LEAST_WORD = 4 };

const char *brc_params_hint(struct brc_param_list list, const char *key, char hint[BRC_HINT_SIZE])
{
    struct brc_nearest nearest = {.text = key};
    for (int i = 0; i < list.n; i++)
        brc_nearest_add(&nearest, list.params[i].key);
    return brc_nearest_hint(&nearest, hint);
}

/* Is the word in the text, without regard to case? strcasestr is not POSIX. */
static bool holds_word(const char *text, const char *word, size_t n)
{
    while (*text && strncasecmp(text, word, n) != 0)
        text++;
    return *text != '\0';
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
