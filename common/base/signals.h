/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The signals that end a run: SIGINT, SIGTERM, SIGHUP, a lost reader (SIGPIPE), and the warnings of
 * batch systems, SIGUSR1, SIGUSR2 and SIGXCPU. Called by the program and by whatever runs step
 * loops; knows nothing of runs, files or child processes. */
#ifndef BRC_SIGNALS_H
#define BRC_SIGNALS_H

#include "common/base/brc.h"

/* From now on these signals, but for SIGPIPE, end the process at once, with a message and the
 * status of an interruption: there is nothing to save yet. */
void brc_signals_leave(void);
/* From now on these signals are held: each run of the process saves its state and ends after the
 * present step. */
void brc_signals_hold(void);
/* A signal is held. It stays so: whoever asks next gets the same answer. */
bool brc_signals_held(void);

#endif
