/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/names.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

void brc_names_add(char *list, size_t size, const char *name)
{
    size_t used = strlen(list), left = size - used;
    if (used + 1 < size && snprintf(list + used, left, "%s%s", used ? ", " : "", name) >= (int)left)
        strcpy(list + size - 4, "...");
}

/* Levenshtein, one row of the matrix at a time. Swapped letters count twice: Damerau's variant
 * needs a second row, and two edits are within the limit of the hint anyway. */
int brc_names_distance(const char *a, const char *b)
{
    int row[BRC_NAME_SIZE + 1];
    size_t na = strlen(a), nb = strlen(b);
    if (na >= BRC_NAME_SIZE || nb >= BRC_NAME_SIZE)
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

/* The first of equally near names stays, which is the one that lists name first. */
void brc_nearest_add(struct brc_nearest *n, const char *name)
{
    int distance = brc_names_distance(n->text, name);
    if (distance == INT_MAX || (*n->name && distance >= n->distance))
        return;
    n->distance = distance;
    snprintf(n->name, sizeof n->name, "%s", name);
}

/* Near is half of the letters, or two edits in a word of three letters or more: `rnu` means run. Of
 * shorter words every other short word would be near. */
const char *brc_nearest_hint(const struct brc_nearest *n, char hint[BRC_HINT_SIZE])
{
    int length = (int)strlen(n->text), limit = length > 2 && length < 4 ? 2 : length / 2;
    hint[0] = '\0';
    if (*n->name && n->distance <= limit)
        snprintf(hint, BRC_HINT_SIZE, "; did you mean '%.100s'?", n->name);
    return hint;
}
