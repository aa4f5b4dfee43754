/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/base/signals.h"

#include "common/base/error.h"

#include <signal.h>
#include <unistd.h>

static const int stop_signal[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGUSR1, SIGUSR2, SIGXCPU};
enum { N_STOP_SIGNALS = sizeof stop_signal / sizeof stop_signal[0] };

/* What the parent has told us to ignore (nohup) stays ignored. */
static bool is_ours(int number)
{
    struct sigaction now;
    return sigaction(number, NULL, &now) == 0 && now.sa_handler != SIG_IGN;
}

/* A handler may call only what POSIX lists as safe in one: write and _exit are, printf and exit are
 * not. */
static void leave(int number)
{
    static const char text[] =
        "breccia: interrupted before the first step; nothing was saved, start again\n";
    ssize_t n = write(STDERR_FILENO, text, sizeof text - 1);
    (void)n, (void)number;
    _exit(brc_error_exit_status(BRC_ERR_NOT_BEGUN));
}

void brc_signals_leave(void)
{
    for (int i = 0; i < N_STOP_SIGNALS; i++)
        if (stop_signal[i] != SIGPIPE && is_ours(stop_signal[i]))
            sigaction(stop_signal[i], &(struct sigaction){.sa_handler = leave}, NULL);
}

/* Signals are blocked and looked for between steps. A handler that sets a flag would need a
 * variable of the process, which libraries must not have, and would interrupt system calls in the
 * middle of writing a state. */
void brc_signals_hold(void)
{
    sigset_t set;
    sigemptyset(&set);
    for (int i = 0; i < N_STOP_SIGNALS; i++)
        if (is_ours(stop_signal[i]))
            sigaddset(&set, stop_signal[i]);
    sigprocmask(SIG_BLOCK, &set, NULL);
}

bool brc_signals_held(void)
{
    sigset_t pending;
    sigemptyset(&pending);
    sigpending(&pending);
    for (int i = 0; i < N_STOP_SIGNALS; i++)
        if (sigismember(&pending, stop_signal[i]) == 1 && is_ours(stop_signal[i]))
            return true;
    return false;
}
