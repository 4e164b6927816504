/* test_setup.c - harness/setup.sh on made-up systems: a PATH with nothing but
 * stand-ins for the compiler, apt-get, sudo and id. Run from the source's root.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "tests/process.h"

/* What stand-ins may be there; "installed" is made by apt-get install. */
static const char *const names[] = {"cc",  "apt-get", "sudo", "id",        "gnuplot",
                                    "env", "mktemp",  "rm",   "installed", "log"};

static void stand_in(const char *name, const char *script) {
  const char *path = temporary_path(name);
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  fprintf(file, "#!/bin/sh\n%s\n", script);
  assert_int_equal(fclose(file), 0);
  assert_int_equal(chmod(path, 0700), 0);
}

static void stand_for(const char *name, const char *real) {
  assert_int_equal(symlink(real, temporary_path(name)), 0);
}

/* A system with a root shell, and a compiler that finds what is installed. */
static int begin(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) unlink(temporary_path(names[i]));
  stand_for("env", "/usr/bin/env");
  stand_for("mktemp", "/usr/bin/mktemp");
  stand_for("rm", "/bin/rm");
  stand_in("cc", "test -e \"$PATH/installed\"");
  stand_in("id", "echo 0");
  return 0;
}

static const char *const installs =
    "echo \"$*\" >>\"$PATH/log\"\n"
    "case $* in *install*) : >\"$PATH/installed\"; : >\"$PATH/gnuplot\"\n"
    "/bin/chmod +x \"$PATH/gnuplot\";; esac";

static struct process setup(const char *also) {
  char path[64] = "PATH=";
  char *environment[] = {strcat(path, temporary), (char *)"CC=cc", NULL};
  return process_run((const char *const[]){"/bin/sh", "harness/setup.sh", also, NULL}, environment,
                     NULL);
}

static char *what_apt_did(void) { return read_text(temporary_path("log")); }

static void test_nothing_missing(void **state) {
  (void)state;
  stand_in("installed", "");
  stand_in("gnuplot", "");
  stand_in("apt-get", installs);
  struct process p = setup(NULL);
  char *did = what_apt_did();
  assert_int_equal(p.exit_status, 0);
  assert_string_equal(p.out, "setup: nothing to install\n");
  assert_string_equal(did, "");
  free(did);
  process_free(&p);
}

static void test_everything_missing(void **state) {
  (void)state;
  stand_in("apt-get", installs);
  struct process p = setup(NULL);
  char *did = what_apt_did();
  assert_int_equal(p.exit_status, 0);
  assert_string_equal(p.err, "");
  assert_non_null(strstr(p.out, "libcmocka-dev: cmocka, runs the tests"));
  assert_string_equal(did, "-q update\n-q install -y --no-install-recommends libsuitesparse-dev "
                           "libgsl-dev libjansson-dev libcmocka-dev gnuplot-nox\n");
  free(did);
  process_free(&p);
}

static void test_only_what_is_missing(void **state) {
  (void)state;
  stand_in("installed", "");
  stand_in("apt-get", installs);
  struct process p = setup(NULL);
  char *did = what_apt_did();
  assert_int_equal(p.exit_status, 0);
  assert_string_equal(did, "-q update\n-q install -y --no-install-recommends gnuplot-nox\n");
  free(did);
  process_free(&p);
}

static void test_through_sudo(void **state) {
  (void)state;
  stand_in("id", "echo 1000");
  stand_in("sudo", "echo sudo >>\"$PATH/log\"; \"$@\"");
  stand_in("apt-get", installs);
  struct process p = setup(NULL);
  char *did = what_apt_did();
  assert_int_equal(p.exit_status, 0);
  assert_non_null(strstr(p.out, "sudo"));
  assert_ptr_equal(strstr(did, "sudo\n-q update\nsudo\n-q install"), did);
  free(did);
  process_free(&p);
}

static void stops(const char *said, const char *also) {
  struct process p = setup(also);
  assert_int_equal(p.exit_status, 1);
  if (!strstr(p.err, said)) fail_msg("'%s' is not in: %s", said, p.err);
  assert_non_null(strstr(p.out, "libgsl-dev")); /* the missing are named all the same */
  process_free(&p);
}

static void test_no_apt(void **state) {
  (void)state;
  stops("no apt-get", NULL);
}

static void test_no_sudo(void **state) {
  (void)state;
  stand_in("id", "echo 1000");
  stand_in("apt-get", installs);
  stops("as root, apt-get install libsuitesparse-dev", NULL);
}

static void test_apt_fails(void **state) {
  (void)state;
  stand_in("apt-get", "exit 100");
  stops("apt-get update failed", NULL);
}

static void test_still_missing(void **state) {
  (void)state;
  stand_in("apt-get", installs);
  stops("does not find: clang", "clang"); /* that apt-get brings no clang */
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup(name, begin)
  const struct CMUnitTest tests[] = {
      TEST(test_nothing_missing),
      TEST(test_everything_missing),
      TEST(test_only_what_is_missing),
      TEST(test_through_sudo),
      TEST(test_no_apt),
      TEST(test_no_sudo),
      TEST(test_apt_fails),
      TEST(test_still_missing),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
