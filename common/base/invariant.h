/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An invariant of the program, never of its input: what a caller, a file or a case can get wrong is
 * an error with a message. Checked in the debug and sanitizer builds; in others the condition is
 * compiled for its types and not evaluated, so that it cannot rot and costs nothing. */
#ifndef BRC_INVARIANT_H
#define BRC_INVARIANT_H

#ifdef BRC_DEBUG
#define BRC_ASSERT(condition) \
    ((condition) ? (void)0 : brc_assert_failed(#condition, __FILE__, __LINE__))
#else
#define BRC_ASSERT(condition) ((void)sizeof(condition))
#endif
void brc_assert_failed(const char *condition, const char *file, int line) __attribute__((noreturn));

#endif
