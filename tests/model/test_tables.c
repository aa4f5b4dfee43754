/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exported tables, read as any program reads CSV (RFC 4180): as many fields a record as the header
 * has, the names and units of the fields, and the values of the state to the bit. Fields that are
 * not saved are not exported. */
#include "common/runs/export.h"
#include "common/output/io_h5.h"
#include "common/output/output.h"
#include "tests/fixture.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Takes one field of a record into out; *at moves behind the comma or the line end. True at the end
 * of the record. */
static bool take_field(const char **at, char *out, size_t size)
{
    const char *c = *at;
    bool is_quoted = *c == '"';
    size_t n = 0;
    for (c += is_quoted; *c && (is_quoted || !strchr(",\r\n", *c)); c++) {
        assert_true(is_quoted || *c != '"'); /* no bare quotes in a plain field */
        if (is_quoted && *c == '"' && *++c != '"')
            break;
        assert_true(n + 1 < size);
        out[n++] = *c;
    }
    out[n] = '\0';
    c += *c == '\r';
    assert_true(*c == ',' || *c == '\n');
    *at = c + 1;
    return *c == '\n';
}

static char *read_file(const char *path)
{
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    fseek(in, 0, SEEK_END);
    long size = ftell(in);
    rewind(in);
    char *text = calloc((size_t)size + 1, 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, in), size);
    fclose(in);
    return text;
}

static void check_value(const char *text, const struct brc_field *f, const void *column, size_t k)
{
    char *end;
    double x = f->type == BRC_F64 ? ((const double *)column)[k] : 0;
    int64_t n = f->type == BRC_I64   ? ((const int64_t *)column)[k]
                : f->type == BRC_I32 ? ((const int32_t *)column)[k]
                : f->type == BRC_U8  ? ((const uint8_t *)column)[k]
                                     : 0;
    if (f->type == BRC_F64)
        assert_true(strtod(text, &end) == x || isnan(x));
    else
        assert_true(strtoll(text, &end, 10) == n);
    assert_true(end > text && *end == '\0');
}

/* Rows of the table in the order of the file, allocated: points lie without gaps there. */
static size_t *rows_of(const struct brc_sim *sim, const struct brc_table *t, size_t *n)
{
    const struct brc_contacts *owner = t == &sim->pairs.points     ? &sim->pairs
                                       : t == &sim->platens.points ? &sim->platens
                                                                   : NULL;
    size_t *row = calloc(t->n + 1, sizeof *row);
    assert_non_null(row);
    *n = 0;
    for (size_t i = 0; !owner && i < t->n; i++)
        row[(*n)++] = i;
    for (size_t i = 0; owner && i < owner->n; i++)
        for (int32_t j = 0; j < owner->np[i]; j++)
            row[(*n)++] = (size_t)(owner->p0[i] + j);
    return row;
}

/* The file holds the table; returns its number of rows. */
static size_t check_table(const struct brc_sim *sim, const char *path, const struct brc_table *t)
{
    char *text = read_file(path), field[512], expected[512];
    const char *at = text;
    size_t n, *from = rows_of(sim, t, &n);
    for (size_t row = 0; row <= n; row++) {
        bool is_end = false;
        for (int i = 0; i < t->set.n; i++)
            for (int j = 0; j < t->set.fields[i].width; j++) {
                const struct brc_field *f = &t->set.fields[i];
                if (!brc_table_saves(t, i))
                    continue;
                assert_false(is_end);
                is_end = take_field(&at, field, sizeof field);
                if (f->width > 1)
                    snprintf(expected, sizeof expected, "%s_%d [%s]", f->name, j + 1, f->unit);
                else
                    snprintf(expected, sizeof expected, "%s [%s]", f->name, f->unit);
                if (row == 0)
                    assert_string_equal(field, expected);
                else
                    check_value(field, f, brc_table_column(t, i),
                                from[row - 1] * (size_t)f->width + (size_t)j);
            }
        assert_true(is_end);
    }
    assert_true(*at == '\0');
    free(text);
    free(from);
    return n;
}

static void test_export(void **state)
{
    static const struct brc_h5_extra none = {NULL, 0, NULL, 0};
    struct fixture *f = *state;
    char saved[64], path[80];
    snprintf(saved, sizeof saved, "/tmp/breccia-test-%ld-tables.h5", (long)getpid());
    snprintf(path, sizeof path, "%s.csv", saved);
    const struct brc_export_options order = {.path = saved, .out = path, .is_forced = true};
    fixture_grid(f, 3, 3, 3, 0.01, 0.5);
    for (int i = 0; i < brc_registry_count(); i++) {
        struct brc_state list;
        int n_tables = 0;
        size_t n_rows = 0;
        fixture_sim(f, brc_registry_at(i), "", "kind: compression; rate: 1e-3 1/s", "");
        fixture_steps(f, 50);
        CHECK_OK(&f->ctx, brc_h5_save(&f->ctx, saved, &f->sim, &none));
        brc_state_list(&f->sim, &list);
        for (int k = 0; k < list.n; k++) {
            const struct brc_state_part *part = &list.part[k];
            if (!part->table || part->set.n == 0)
                continue;
            CHECK_OK(&f->ctx, brc_export_table(&f->ctx, &order, part->path));
            n_rows += check_table(&f->sim, path, part->table);
            n_tables++;
        }
        assert_true(n_tables >= 5 && n_rows > 100);
        fixture_drop_sim(f);
    }
    unlink(saved);
    unlink(path);
}

static void test_cells(void **state)
{
    static const char *const text[] = {
        "plain [m]", "with, comma", "a \"quoted\" word", "two\nlines", "", "\"", " blanks "};
    (void)state;
    for (size_t i = 0; i < sizeof text / sizeof text[0]; i++) {
        char *line = NULL, field[64];
        size_t size = 0;
        FILE *out = open_memstream(&line, &size);
        brc_output_cell(out, text[i]);
        fputs(",last\n", out);
        fclose(out);
        const char *at = line;
        assert_false(take_field(&at, field, sizeof field));
        assert_string_equal(field, text[i]);
        assert_true(take_field(&at, field, sizeof field));
        assert_string_equal(field, "last");
        free(line);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {FIXTURE_TEST(test_export), cmocka_unit_test(test_cells)};
    return cmocka_run_group_tests_name("tables", tests, NULL, NULL);
}
