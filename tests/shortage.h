/* shortage.h - allocations that fail when told to, whoever asks: the program, jansson, CHOLMOD,
 * GSL and the C library. To be included by one file of a test program.
 *
 * The functions below take the place of the C library's. Under the address sanitizer, which has
 * taken it already, they are put before it by the linker (Makefile), which reaches the program
 * itself, and by hooks, which reach jansson and CHOLMOD; leaks are then its business.
 * Spared is what the thread runtime and the loader ask for: they end the program themselves.
 * So is one function of GSL (below). What GSL leaves behind is not counted: a matrix without room
 * for its numbers keeps its head.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SHORTAGE_H
#define CB_SHORTAGE_H

#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <jansson.h>
#include <link.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#ifdef __SANITIZE_ADDRESS__
#include <SuiteSparse_config.h>
#define OURS(name) __wrap_##name
#define THEIRS(name) __real_##name
static const bool shortage_reaches_libc = false;
void *__real_aligned_alloc(size_t alignment, size_t bytes);
#else
#define OURS(name) name
#define THEIRS(name) __libc_##name
static const bool shortage_reaches_libc = true;
void *__libc_memalign(size_t alignment, size_t bytes);
#endif
void *THEIRS(malloc)(size_t bytes);
void *THEIRS(calloc)(size_t n, size_t size);
void *THEIRS(realloc)(void *old, size_t bytes);
void THEIRS(free)(void *block);
#ifdef __SANITIZE_ADDRESS__
void *__wrap_malloc(size_t bytes);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *old, size_t bytes);
void *__wrap_reallocarray(void *old, size_t n, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t bytes);
void __wrap_free(void *block);
#endif

/* Of the thread that tests; the others are left alone. */
static _Thread_local bool shortage_armed;
static struct {
  size_t asked, fails_at; /* allocations so far; the one that fails, from 1; 0: none */
  bool lasts;             /* and all after it */
  size_t failed;
  struct shortage_code {
    size_t count;
    uintptr_t low[8], high[8];
  } spared, leaky; /* who never fails; who is not asked for what is left */
} shortage;

/* ---- what is still there ------------------------------------------------------------- */

/* Blocks that were allocated while armed and not freed: an open hash table. */
enum { SHORTAGE_SLOTS = 1 << 16 };
static void *shortage_live[SHORTAGE_SLOTS];
static size_t shortage_live_count;

static size_t shortage_slot(const void *block) {
  return (size_t)(((uintptr_t)block >> 4) * UINT64_C(0x9E3779B97F4A7C15) >> 48) &
         (SHORTAGE_SLOTS - 1);
}

static void shortage_remember(void *block) {
  size_t i = shortage_slot(block);
  if (shortage_live_count > SHORTAGE_SLOTS / 2) abort();
  while (shortage_live[i]) i = (i + 1) % SHORTAGE_SLOTS;
  shortage_live[i] = block;
  shortage_live_count++;
}

static void shortage_forget(const void *block) {
  size_t i = shortage_slot(block);
  while (shortage_live[i] && shortage_live[i] != block) i = (i + 1) % SHORTAGE_SLOTS;
  if (!shortage_live[i]) return;
  shortage_live_count--;
  for (size_t k = i;;) { /* close the gap */
    shortage_live[i] = NULL;
    size_t home;
    do {
      k = (k + 1) % SHORTAGE_SLOTS;
      if (!shortage_live[k]) return;
      home = shortage_slot(shortage_live[k]);
    } while ((k - home) % SHORTAGE_SLOTS < (k - i) % SHORTAGE_SLOTS);
    shortage_live[i] = shortage_live[k];
    i = k;
  }
}

/* ---- allocations ------------------------------------------------------------------------ */

static bool shortage_within(const struct shortage_code *code, const void *caller) {
  for (size_t i = 0; i < code->count; i++)
    if ((uintptr_t)caller >= code->low[i] && (uintptr_t)caller < code->high[i]) return true;
  return false;
}

static int shortage_find(struct dl_phdr_info *info, size_t size, void *context) {
  static const char *const spared[] = {"libgomp", "libomp", "ld-linux"};
  (void)size, (void)context;
  struct shortage_code *code = NULL;
  for (size_t i = 0; i < sizeof spared / sizeof *spared; i++)
    if (strstr(info->dlpi_name, spared[i])) code = &shortage.spared;
  if (strstr(info->dlpi_name, "libgsl.")) code = &shortage.leaky;
  for (int i = 0; code && i < info->dlpi_phnum && code->count < 8; i++) {
    const ElfW(Phdr) *part = &info->dlpi_phdr[i];
    if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
    code->low[code->count] = info->dlpi_addr + part->p_vaddr;
    code->high[code->count] = code->low[code->count] + part->p_memsz;
    code->count++;
  }
  return 0;
}

/* GSL's reduction to two diagonals, in its singular values, does not look whether it has got
 * its three numbers: nobody who calls it could do anything about it. */
static bool shortage_is_careless(const void *caller) {
  void *frame[8];
  Dl_info where;
  if (!shortage_within(&shortage.leaky, caller)) return false;
  const int frames = backtrace(frame, 8);
  for (int i = 0; i < frames; i++)
    if (dladdr(frame[i], &where) && where.dli_sname &&
        strcmp(where.dli_sname, "gsl_linalg_bidiag_decomp") == 0)
      return true;
  return false;
}

/* Does this one fail? It is counted. */
static bool shortage_strikes(const void *caller) {
  if (!shortage_armed) return false;
  if (shortage_within(&shortage.spared, caller) || shortage_is_careless(caller)) return false;
  const size_t n = ++shortage.asked;
  if (!shortage.fails_at || n < shortage.fails_at || (n > shortage.fails_at && !shortage.lasts))
    return false;
  shortage.failed++;
  errno = ENOMEM;
  return true;
}

static void *shortage_take(void *block, const void *caller) {
  if (shortage_armed && block && !shortage_within(&shortage.leaky, caller))
    shortage_remember(block);
  return block;
}

void *OURS(malloc)(size_t bytes) {
  const void *caller = __builtin_return_address(0);
  return shortage_strikes(caller) ? NULL : shortage_take(THEIRS(malloc)(bytes), caller);
}

void *OURS(calloc)(size_t n, size_t size) {
  const void *caller = __builtin_return_address(0);
  return shortage_strikes(caller) ? NULL : shortage_take(THEIRS(calloc)(n, size), caller);
}

static void *shortage_realloc(void *old, size_t bytes, const void *caller) {
  if (shortage_strikes(caller)) return NULL;
  if (shortage_armed && old) shortage_forget(old);
  void *block = THEIRS(realloc)(old, bytes);
  shortage_take(block ? block : bytes ? old : NULL, caller);
  return block;
}

void *OURS(realloc)(void *old, size_t bytes) {
  return shortage_realloc(old, bytes, __builtin_return_address(0));
}

void *OURS(reallocarray)(void *old, size_t n, size_t size) {
  size_t bytes;
  if (!__builtin_mul_overflow(n, size, &bytes))
    return shortage_realloc(old, bytes, __builtin_return_address(0));
  errno = ENOMEM;
  return NULL;
}

void *OURS(aligned_alloc)(size_t alignment, size_t bytes) {
  const void *caller = __builtin_return_address(0);
  if (shortage_strikes(caller)) return NULL;
#ifdef __SANITIZE_ADDRESS__
  return shortage_take(__real_aligned_alloc(alignment, bytes), caller);
#else
  return shortage_take(__libc_memalign(alignment, bytes), caller);
#endif
}

void OURS(free)(void *block) {
  if (shortage_armed && block) shortage_forget(block);
  THEIRS(free)(block);
}

/* ---- for tests --------------------------------------------------------------------------- */

/* Once, before the first workload. */
static void shortage_begin(void) {
  void *frame[1];
  backtrace(frame, 1); /* allocates when it is first called */
  dl_iterate_phdr(shortage_find, NULL);
#ifdef __SANITIZE_ADDRESS__
  json_set_alloc_funcs(OURS(malloc), OURS(free));
  SuiteSparse_config.malloc_func = OURS(malloc);
  SuiteSparse_config.calloc_func = OURS(calloc);
  SuiteSparse_config.realloc_func = OURS(realloc);
  SuiteSparse_config.free_func = OURS(free);
#endif
}

static void shortage_arm(size_t fails_at, bool lasts) {
  if (shortage_live_count) memset(shortage_live, 0, sizeof shortage_live);
  shortage_live_count = shortage.asked = shortage.failed = 0;
  shortage.fails_at = fails_at;
  shortage.lasts = lasts;
  shortage_armed = true;
}

static void shortage_disarm(void) { shortage_armed = false; }

#endif
