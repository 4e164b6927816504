/* Reads /proc and /sys, which any Linux has in part: each entry may be missing.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/environment.h"

#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "harness/files/output.h"

#define CPU0 "/sys/devices/system/cpu/cpu0/"

/* First line of the file without its newline, or the fallback. */
static void read_line(const char *path, const char *fallback, size_t size, char *line) {
  FILE *f = fopen(path, "r");
  if (!f || !fgets(line, (int)size, f)) snprintf(line, size, "%s", fallback);
  line[strcspn(line, "\n")] = 0;
  if (f) fclose(f);
}

/* Value of the first line "key : value" in /proc/cpuinfo; untouched if none. */
static void read_cpuinfo(const char *key, size_t size, char *value) {
  FILE *f = fopen("/proc/cpuinfo", "r");
  char line[512];
  while (f && fgets(line, sizeof line, f)) {
    const char *colon = strchr(line, ':');
    if (!colon || strncmp(line, key, strlen(key)) != 0) continue;
    line[strcspn(line, "\n")] = 0;
    snprintf(value, size, "%s", colon + 1 + strspn(colon + 1, " "));
    break;
  }
  if (f) fclose(f);
}

/* Cores in a list such as "0-3,8". */
static unsigned count_cores(const char *list) {
  unsigned count = 0, first, last;
  for (int used; sscanf(list, "%u%n", &first, &used) == 1; list += *list == ',') {
    list += used;
    last = first;
    if (sscanf(list, "-%u%n", &last, &used) == 1) list += used;
    count += last - first + 1;
  }
  return count;
}

static void read_caches(struct cb_environment *e) {
  for (int i = 0; i < 8; i++) {
    struct cb_cache cache = {0};
    char path[96], text[64], suffix = ' ';
    snprintf(path, sizeof path, CPU0 "cache/index%d/size", i);
    read_line(path, "", sizeof text, text);
    if (sscanf(text, "%lf%c", &cache.bytes, &suffix) < 1) return;
    cache.bytes *= suffix == 'K' ? 1024 : suffix == 'M' ? 1024 * 1024 : 1;
    snprintf(path, sizeof path, CPU0 "cache/index%d/level", i);
    read_line(path, "0", sizeof text, text);
    cache.level = (unsigned)atoi(text);
    snprintf(path, sizeof path, CPU0 "cache/index%d/type", i);
    read_line(path, "unknown", sizeof cache.type, cache.type);
    snprintf(path, sizeof path, CPU0 "cache/index%d/shared_cpu_list", i);
    read_line(path, "", sizeof text, text);
    cache.sharing = count_cores(text);
    e->caches[e->cache_count++] = cache;
  }
}

/* The name, and what it may hide: hypervisors give one name to processors of several
 * generations. */
static void read_cpu(size_t size, char *cpu) {
  char name[96] = "unknown", family[16] = "", model[16] = "";
  read_cpuinfo("model name", sizeof name, name);
  read_cpuinfo("cpu family", sizeof family, family);
  read_cpuinfo("model\t", sizeof model, model);
  if (*family && *model)
    snprintf(cpu, size, "%s (family %s, model %s)", name, family, model);
  else
    snprintf(cpu, size, "%s", name);
}

/* System and version number; what follows a hyphen names who built it. */
static void read_kernel(size_t size, char *kernel) {
  struct utsname name;
  if (uname(&name) != 0) {
    snprintf(kernel, size, "unknown");
    return;
  }
  name.release[strcspn(name.release, "-")] = 0;
  snprintf(kernel, size, "%.16s %.24s %.16s", name.sysname, name.release, name.machine);
}

void cb_environment_read(struct cb_environment *e) {
  *e = (struct cb_environment){.threads = 1};
  char mhz[32] = "0";
  read_cpu(sizeof e->cpu, e->cpu);
  read_cpuinfo("cpu MHz", sizeof mhz, mhz);
  e->mhz = atof(mhz);
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) e->cores = (size_t)CPU_COUNT(&set);
  e->memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGE_SIZE);
  read_line(CPU0 "cpufreq/scaling_governor", "unknown", sizeof e->governor, e->governor);
  read_kernel(sizeof e->kernel, e->kernel);
#ifdef __clang__
  snprintf(e->compiler, sizeof e->compiler, "%s", __VERSION__);
#else
  snprintf(e->compiler, sizeof e->compiler, "gcc %s", __VERSION__);
#endif
  snprintf(e->flags, sizeof e->flags, "%s", CB_COMPILER_FLAGS);
  snprintf(e->commit, sizeof e->commit, "%s", CB_COMMIT);
  const time_t now = time(NULL);
  struct tm utc;
  if (gmtime_r(&now, &utc)) strftime(e->date, sizeof e->date, "%Y-%m-%dT%H:%M:%SZ", &utc);
  read_caches(e);
}

static json_t *caches_json(const struct cb_environment *e) {
  json_t *list = json_array();
  for (size_t i = 0; list && i < e->cache_count; i++) {
    const struct cb_cache *c = &e->caches[i];
    json_t *cache =
        json_pack("{s:s, s:I, s:I, s:I}", "type", c->type, "level", (json_int_t)c->level, "size",
                  (json_int_t)c->bytes, "num_sharing", (json_int_t)c->sharing);
    if (json_array_append_new(list, cache) != 0) {
      json_decref(list);
      list = NULL;
    }
  }
  return list;
}

/* What each arithmetic is compiled with beside the program's flags. */
static json_t *arithmetic_flags_json(void) {
  json_t *flags = json_object();
  for (const struct cb_arithmetic *const *a = cb_arithmetics; flags && *a; a++)
    if (json_object_set_new(flags, (*a)->name, json_string((*a)->flags)) != 0) {
      json_decref(flags);
      flags = NULL;
    }
  return flags;
}

json_t *cb_environment_json(const struct cb_environment *e) {
  const json_int_t scaling =
      strcmp(e->governor, "performance") != 0 && strcmp(e->governor, "unknown") != 0;
  /* json_pack fails, and frees what it was given, when a part is NULL. */
  return json_pack("{s:s, s:I, s:f, s:b, s:o, s:s, s:s, s:s, s:s, s:f, s:s, s:s, s:o, s:s, s:I}",
                   "date", e->date, "num_cpus", (json_int_t)e->cores, "mhz_per_cpu", e->mhz,
                   "cpu_scaling_enabled", (int)scaling, "caches", caches_json(e),
                   "library_build_type", "release", "cpu", e->cpu, "governor", e->governor,
                   "kernel", e->kernel, "memory_bytes", e->memory, "compiler", e->compiler, "flags",
                   e->flags, "arithmetic_flags", arithmetic_flags_json(), "commit", e->commit,
                   "threads", (json_int_t)e->threads);
}

void cb_environment_line(const struct cb_environment *e, size_t size, char *line) {
  snprintf(line, size, "%s, %zu core%s | %s %s | commit %s | %.10s", e->cpu, e->cores,
           e->cores == 1 ? "" : "s", e->compiler, e->flags, e->commit, e->date);
}

enum cb_status cb_environment_footer(const char *directory, const char *name) {
  struct cb_environment e;
  struct cb_output o;
  char line[1024];
  cb_environment_read(&e);
  cb_environment_line(&e, sizeof line, line);
  enum cb_status status = cb_output_open(&o, directory, name);
  if (status) return status;
  fprintf(o.stream, "%s\n", line);
  return cb_output_commit(&o);
}
