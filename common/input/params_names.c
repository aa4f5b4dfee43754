/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which key was meant by one that is not in a list. */
#include "common/input/params.h"

#include <ctype.h>
#include <limits.h>
#include <string.h>

enum { NAME_SIZE = 128, LEAST_WORD = 4 };

int brc_params_distance(const char *a, const char *b)
{
    int row[NAME_SIZE + 1];
    size_t na = strlen(a), nb = strlen(b);
    if (na >= NAME_SIZE || nb >= NAME_SIZE)
        return INT_MAX;
    for (size_t j = 0; j <= nb; j++)
        row[j] = (int)j;
    for (size_t i = 1; i <= na; i++) {
        int corner = row[0];
        row[0] = (int)i;
        for (size_t j = 1; j <= nb; j++) {
            int change =
                corner + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]));
            int shift = 1 + (row[j] < row[j - 1] ? row[j] : row[j - 1]);
            corner = row[j];
            row[j] = change < shift ? change : shift;
        }
    }
    return row[nb];
}

const char *brc_params_nearest(struct brc_param_list list, const char *key)
{
    const char *nearest = NULL;
    int best = INT_MAX;
    for (int i = 0; i < list.n; i++) {
        int d = brc_params_distance(key, list.params[i].key);
        if (d < best) {
            best = d;
            nearest = list.params[i].key;
        }
    }
    return nearest && brc_params_is_near(key, best) ? nearest : NULL;
}

bool brc_params_is_near(const char *text, int distance)
{
    return distance <= (int)(strlen(text) / 2);
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
