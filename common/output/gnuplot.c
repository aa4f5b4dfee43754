/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gnuplot runs in the folder with names relative to it, and every text in a script is quoted beyond
 * its reach: titles come from cases that others wrote. Without gnuplot a run is complete all the
 * same. */
#include "common/output/gnuplot.h"

#include "common/base/folders.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* noenhanced: in a title a_b and x^2 stand as they are. */
void brc_gnuplot_head(FILE *out, const char *name, int width, int height, int font)
{
    fprintf(out,
            "# gnuplot %s.gp draws %s.png\n"
            "set encoding utf8\n"
            "set terminal pngcairo noenhanced size %d,%d font 'sans,%d' background '#ffffff'\n"
            "set output '%s.png'\n",
            name, name, width, height, font, name);
}

/* Between double quotes gnuplot runs what stands in backquotes and fills in macros, between single
 * ones two quotes in a row end the text. Octal codes are read after all that, so everything but
 * plain characters is written as one. Titles come from cases of others: a title that runs a command
 * would be a hole. */
void brc_gnuplot_quoted(FILE *out, const char *text)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                " _-+=./,:;()[]%";
    fputc('"', out);
    for (; *text; text++)
        fprintf(out, strchr(plain, *text) ? "%c" : "\\%03o", (unsigned char)*text);
    fputc('"', out);
}

/* Runs gnuplot in the folder; *status is its exit status, 127 when it is not installed. Not by
 * system(): a shell would read the names once more, and SIGINT would be ignored while it waits. */
static int run_gnuplot(struct brc_context *ctx, const char *dir, const char *script, int *status)
{
    pid_t child = fork();
    if (child < 0)
        BRC_FAIL(ctx, BRC_ERR_IO, "cannot start gnuplot: %s", strerror(errno));
    if (child == 0) {
        sigset_t none; /* the run may hold back signals */
        sigemptyset(&none);
        sigprocmask(SIG_SETMASK, &none, NULL);
        /* without a locale gnuplot 6 complains of `set encoding utf8` */
        setenv("LC_ALL", "C.UTF-8", 1);
        if (chdir(dir) == 0 && freopen("gnuplot.log", "a", stderr))
            execlp("gnuplot", "gnuplot", script, (char *)NULL);
        _exit(127);
    }
    int how;
    while (waitpid(child, &how, 0) < 0)
        if (errno != EINTR)
            BRC_FAIL(ctx, BRC_ERR_IO, "lost gnuplot: %s", strerror(errno));
    *status = WIFEXITED(how) ? WEXITSTATUS(how) : 1;
    return 0;
}

/* gnuplot does not tell when the disk is full: a whole picture ends with the mark of PNG. */
static int check_picture(struct brc_context *ctx, const char *dir, const char *name)
{
    static const char mark[8] = {'I', 'E', 'N', 'D', '\xae', 'B', '\x60', '\x82'};
    char path[BRC_PATH_SIZE], end[8] = "";
    BRC_TRY(brc_folder_path(ctx, dir, name, path));
    FILE *file = fopen(path, "rb");
    if (file && fseek(file, -(long)sizeof end, SEEK_END) == 0 &&
        fread(end, sizeof end, 1, file) < 1)
        end[0] = '\0';
    if (file)
        fclose(file);
    if (memcmp(end, mark, sizeof mark) != 0)
        BRC_FAIL(ctx, BRC_ERR_IO,
                 "gnuplot left no whole picture %s: is the disk full? All other results are there; "
                 "make room, then run gnuplot in that folder on its .gp file",
                 path);
    return 0;
}

/* A picture that fails does not end a run whose results are there: gnuplot's own messages are kept
 * beside it. A full disk is another matter, see check_picture. */
int brc_gnuplot_draw(struct brc_context *ctx, const char *dir, const char *const *picture, int n)
{
    for (int i = 0; i < n; i++) {
        char script[64], image[64];
        int status = 0;
        snprintf(script, sizeof script, "%s.gp", picture[i]);
        snprintf(image, sizeof image, "%s.png", picture[i]);
        BRC_TRY(run_gnuplot(ctx, dir, script, &status));
        if (status == 127) {
            brc_log(ctx,
                    "gnuplot is not installed, so pictures are left out; the scripts are %s/*.gp",
                    dir);
            return 0;
        }
        if (status != 0)
            brc_log(ctx, "gnuplot failed on %s/%s; its messages are in gnuplot.log there", dir,
                    script);
        else
            BRC_TRY(check_picture(ctx, dir, image));
    }
    return 0;
}
