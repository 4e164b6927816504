/* Scene files: what is read, what is refused, and in which words.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/scene/body.h"
#include "harness/scene/json.h"
#include "tests/process.h"

static const char *const GOOD =
    "{\n"
    " \"about\": \"a block\",\n"
    " \"geometry\": {\"block\": {\"cells\": [2, 2, 3], \"cell_m\": 0.1}},\n"
    " \"material\": {\"young_pa\": 1e5, \"poisson\": 0.3, \"density_kg_m3\": 1000},\n"
    " \"fixed\": [{\"face\": \"z-\"}],\n"
    " \"loads\": [{\"low\": [0, 0, 1], \"high\": [1, 1, 1],\n"
    "            \"force_n\": [1, 0, 0]}],\n"
    " \"step_s\": 0.001,\n"
    " \"duration_s\": 0.1,\n"
    " \"needs\": {\"newton\": true, \"torque\": 1e-3}\n"
    "}\n";

/* GOOD with the first `from` replaced by `to`, as a file. */
static const char *scene_file(const char *from, const char *to) {
  const char *path = temporary_path("scene.json"), *at = strstr(GOOD, from);
  FILE *f = fopen(path, "w");
  assert_non_null(at);
  fprintf(f, "%.*s%s%s", (int)(at - GOOD), GOOD, to, at + strlen(from));
  fclose(f);
  return path;
}

static void a_good_scene_is_read(void **state) {
  (void)state;
  struct cb_scene s;
  assert_int_equal(cb_scene_read(scene_file("{", "{"), &s), CB_OK);
  assert_string_equal(s.name, "scene");
  assert_string_equal(s.about, "a block");
  assert_true(s.cells[2] == 3 && s.cell == 0.1 && s.step == 0.001);
  assert_true(s.fixed[0].low[2] == 0 && s.fixed[0].high[2] == 0 && s.fixed[0].high[0] == 1);
  assert_true(s.load[0].force[0] == 1 && s.load_count == 1 && s.handle_count == 0);
  assert_int_equal(s.needs.laws, CB_KEEPS(CB_LAW_NEWTON));
  assert_true(s.needs.torque == 1e-3 && isinf(s.needs.displacement) && !s.needs.inversion);
}

/* GOOD with `from` replaced by `to`: the line and the whole sentence. */
static const struct {
  const char *from, *to;
  int line;
  const char *said;
} BAD[] = {
    /* keys */
    {"young_pa", "young", 4, "'young' has no unit; write 'young_pa'"},
    {"step_s", "step", 8, "'step' has no unit; write 'step_s'"},
    {"\"poisson\": 0.3", "\"poison\": 0.3", 4, "unknown key 'poison' (nearest: 'poisson')"},
    {"\"newton\"", "\"neuton\"", 10, "unknown key 'neuton' (nearest: 'newton')"},
    {"\"cell_m\": 0.1", "\"cell_m\": 0.1, \"split\": 5", 3,
     "unknown key 'split' (nearest: 'cells')"},
    {"\"step_s\": 0.001,", "", 1, "'step_s' is missing"},
    {"\"poisson\": 0.3, ", "", 4, "'poisson' is missing"},
    {"            \"force_n\": [1, 0, 0]", "\"face\": \"z+\"", 6, "'force_n' is missing"},
    {"young_pa", "you\\nng_pa", 4, "unknown key 'you?ng_pa' (nearest: 'young_pa')"},
    /* types */
    {"1e5", "\"soft\"", 4, "'young_pa' is a text; it must be a number"},
    {"1e5", "null", 4, "'young_pa' is null; it must be a number"},
    {"1e5", "true", 4, "'young_pa' is true; it must be a number"},
    {"\"a block\"", "7", 2, "'about' is 7; it must be a text"},
    {"\"newton\": true", "\"newton\": 1", 10, "'newton' is 1; it must be true or false"},
    {"[{\"face\": \"z-\"}]", "{}", 5,
     "'fixed' is an object; it must be a list of objects in brackets"},
    {"[{\"face\": \"z-\"}]", "[\"z-\"]", 5,
     "entry 1 of 'fixed' is no object; 'fixed' must be a list of objects in brackets"},
    {"{\"newton\": true, \"torque\": 1e-3}", "[]", 10,
     "'needs' is a list of 0; it must be an object in braces"},
    {"[1, 0, 0]", "[1, 0]", 7, "'force_n' is a list of 2; it must be three numbers in brackets"},
    {"[1, 0, 0]", "[1, 0, \"no\"]", 7, "'force_n' is a text; it must be a number"},
    {"[2, 2, 3]", "[2, 3]", 3, "'cells' is a list of 2; it must be three numbers in brackets"},
    {"[2, 2, 3]", "[2, 2.5, 3]", 3, "'cells' is 2.5; it must be a whole number"},
    /* ranges */
    {"[2, 2, 3]", "[2, 0, 3]", 3, "'cells' is 0; it must be from 1 to 200"},
    {"0.001", "0", 8, "'step_s' is 0; it must be above 0"},
    {"1e5", "-1", 4, "'young_pa' is -1; it must be at least 0"},
    {"1e5", "1.7e308", 4, "'young_pa' is 1.7e+308; the stresses would not be finite"},
    {"\"poisson\": 0.3", "\"poisson\": 0.5", 4,
     "'poisson' is 0.5; it must be above -1 and below 0.5"},
    {"\"low\": [0, 0, 1]", "\"low\": [0, 0, 1.5]", 6, "'low' is 1.5; it must be from 0 to 1"},
    {"0.1,\n \"needs\"", "1e-6,\n \"needs\"", 9,
     "'duration_s' is 0.001 steps of 'step_s'; it must be 1 to 10000000"},
    {"a block", "", 2, "'about' has 0 bytes; it must be a sentence of 1 to 199"},
    /* choices */
    {"\"z-\"", "\"down\"", 5, "'face' is 'down'; it must be x-, x+, y-, y+, z- or z+"},
    {"\"face\": \"z-\"", "", 5,
     "nodes are chosen by 'face', or by 'low' and 'high', corners in fractions of the bounding "
     "box"},
    {"\"face\": \"z-\"", "\"face\": \"z-\", \"low\": [0, 0, 0]", 5,
     "nodes are chosen by 'face', or by 'low' and 'high', corners in fractions of the bounding "
     "box"},
    {"\"high\": [1, 1, 1]", "\"high\": [1, 1, 0.5]", 6,
     "'low' is 1 and 'high' 0.5 along z; 'low' must not be the higher"},
    {"{\"block\": {\"cells\": [2, 2, 3], \"cell_m\": 0.1}}", "{}", 3,
     "'geometry' must be one of 'block', 'beam', 'shape' and 'mesh'"},
    {"{\"block\": {\"cells\": [2, 2, 3], \"cell_m\": 0.1}}",
     "{\"beam\": {\"length_m\": 1, \"width_m\": 0.3, \"cells_across\": 1}}", 3,
     "length_m over width_m times cells_across is 3.33333 cells along the beam; it must be a whole "
     "number from 1 to 10000"},
    {"{\"block\": {\"cells\": [2, 2, 3], \"cell_m\": 0.1}}",
     "\n {\"shape\": {\"name\": \"hare\", \"cells\": 9, \"length_m\": 1}}", 4,
     "there is no shape 'hare'; 'name' must be rabbit or liver"},
    {"0.1,\n \"needs\"",
     "0.1,\n \"stiffness\": [{\"from_s\": 0.02, \"young_pa\": 1},\n"
     "{\"from_s\": 0.02, \"young_pa\": 2}], \"needs\"",
     11,
     "'from_s' is 0.02; it must be above 0.02, where the stage before begins, and below "
     "'duration_s', 0.1"},
    {"0.1,\n \"needs\"", "0.1,\n \"stiffness\": [{\"from_s\": 0.1, \"young_pa\": 1}], \"needs\"",
     10,
     "'from_s' is 0.1; it must be above 0, where the stage before begins, and below "
     "'duration_s', 0.1"},
    {"\"step_s\"", "\"stiffness\": [{\"from_s\": 0.01, \"young_pa\": -1}], \"step_s\"", 8,
     "'young_pa' is -1; it must be at least 0"},
    {"\"step_s\"", "\"stiffness\": [{\"from_s\": 0.01, \"young_pa\": 1.7e308}], \"step_s\"", 8,
     "'young_pa' is 1.7e+308; the stresses would not be finite"},
    {"\"step_s\"", "\"stiffness\": [{\"young_pa\": 1}], \"step_s\"", 8, "'from_s' is missing"},
    {"\"step_s\"", "\"ground_m\": \"low\", \"step_s\"", 8,
     "'ground_m' is a text; it must be a number"},
    {"\"step_s\"", "\"handles\": [{\"face\": \"z+\", \"over_s\": 1, \"until_s\": 0}], \"step_s\"",
     8, "'until_s' is 0; it must be above 0"},
    {"1e-3}", "1e-3, \"rest_distance\": 0}", 10, "'rest_distance' is 0; it must be above 0"},
    {"\"step_s\"",
     "\"handles\": [{\"face\": \"z+\", \"over_s\": 1}],\n"
     " \"damping\": {\"stiffness_s\": 0.1}, \"step_s\"",
     9,
     "'stiffness_s' would drag on what moves with 'handles'; leave one out, or damp by "
     "'mass_1_s'"},
};

static void a_bad_scene_is_refused_in_one_sentence(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
    struct cb_scene s = {.step = 77};
    char expected[512];
    const char *path = scene_file(BAD[i].from, BAD[i].to);
    assert_int_equal(cb_scene_read(path, &s), CB_INPUT);
    assert_true(s.step == 77); /* untouched */
    snprintf(expected, sizeof expected, "%s:%d: %s", path, BAD[i].line, BAD[i].said);
    assert_string_equal(cb_error_message(), expected);
  }
  struct cb_scene s;
  assert_int_equal(cb_scene_read(temporary_path("none.json"), &s), CB_IO);
}

/* In the words of jansson, which change with its version. */
static void what_is_no_json_is_refused_with_its_line(void **state) {
  (void)state;
  static const struct {
    const char *from, *to;
    int line;
    const char *about;
  } bad[] = {
      {"\"poisson\": 0.3", "\"poisson\": NaN", 4, "NaN"},
      {"1e5", "1e999", 4, "overflow"},
      {"\"step_s\": 0.001,", "\"step_s\": 0.001, \"step_s\": 1,", 8, "step_s"},
      {"\"duration_s\": 0.1,", "\"duration_s\": 0.1", 10, "needs"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    struct cb_scene s;
    char place[600];
    const char *path = scene_file(bad[i].from, bad[i].to);
    assert_int_equal(cb_scene_read(path, &s), CB_INPUT);
    snprintf(place, sizeof place, "%s:%d: ", path, bad[i].line);
    assert_memory_equal(cb_error_message(), place, strlen(place));
    assert_non_null(strstr(cb_error_message() + strlen(place), bad[i].about));
  }
}

/* Whether a selection has nodes is known when there is a mesh; the line still is. */
static void a_selection_needs_nodes(void **state) {
  (void)state;
  static const struct {
    const char *from, *to;
    int line;
    const char *said;
  } bad[] = {
      {"\"low\": [0, 0, 1], \"high\": [1, 1, 1]", "\"low\": [0.1, 0, 1], \"high\": [0.2, 1, 1]", 6,
       "entry 1 of 'loads' holds no node; widen its box"},
      {"[{\"face\": \"z-\"}]",
       "[{\"face\": \"z-\"},\n  {\"low\": [0.1, 0, 0], \"high\": [0.2, 1, 1]}]", 6,
       "entry 2 of 'fixed' holds no node; widen its box"},
      {"\"low\": [0, 0, 1], \"high\": [1, 1, 1]", "\"face\": \"z-\"", 6,
       "entry 1 of 'loads' pushes only nodes that are held or moved"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    struct cb_scene s;
    struct cb_body b;
    char expected[600];
    const char *path = scene_file(bad[i].from, bad[i].to);
    assert_int_equal(cb_scene_read(path, &s), CB_OK);
    assert_int_equal(cb_body_create(&s, 1, &b), CB_INPUT);
    snprintf(expected, sizeof expected, "%s:%d: %s", path, bad[i].line, bad[i].said);
    assert_string_equal(cb_error_message(), expected);
    s.path[0] = '\0'; /* as one that was made in memory */
    assert_int_equal(cb_body_create(&s, 1, &b), CB_INPUT);
    assert_non_null(strstr(cb_error_message(), bad[i].said));
  }
}

/* A text that is no file: the same scene, the same sentences. */
static void a_text_is_read_like_a_file(void **state) {
  (void)state;
  struct cb_scene file, text;
  assert_int_equal(cb_scene_read(scene_file("{", "{"), &file), CB_OK);
  assert_int_equal(cb_scene_parse("scene.json", GOOD, &text), CB_OK);
  assert_true(text.path[0] == '\0' && file.path[0] != '\0');
  memcpy(text.path, file.path, sizeof text.path);
  assert_memory_equal(&text, &file, sizeof text);
  assert_int_equal(cb_scene_parse("mine", "{\n\"about\": 7}", &text), CB_INPUT);
  assert_string_equal(cb_error_message(), "mine:2: 'about' is 7; it must be a text");
}

static void a_place_has_a_line(void **state) {
  (void)state;
  static const char *const TEXT = "\n"
                                  "{ \"a\": \"}\\\"]{\",\n"            /* 2 */
                                  "  \"b\" : [ [1, {\"a\": 2}],\n"     /* 3 */
                                  "    {\"a\": {}, \"ab\":\n"          /* 4 */
                                  "     3}, [],\n"                     /* 5 */
                                  "    7 ],\n"                         /* 6 */
                                  "  \"ab\": {\"b\": 1,\n \"a\": 2}}"; /* 7, 8 */
  static const struct {
    const char *place;
    size_t line;
  } places[] = {{"", 2},       {"a", 2},     {"b", 3},   {"b/0/1/a", 3}, {"b/1", 4},
                {"b/1/ab", 4}, {"b/2", 5},   {"b/3", 6}, {"ab", 7},      {"ab/a", 8},
                {"none", 2},   {"ab/no", 7}, {"b/9", 3}, {"a/b", 2}};
  for (size_t i = 0; i < sizeof places / sizeof *places; i++)
    assert_int_equal(cb_json_line(TEXT, places[i].place), places[i].line);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_good_scene_is_read),
      cmocka_unit_test(a_bad_scene_is_refused_in_one_sentence),
      cmocka_unit_test(what_is_no_json_is_refused_with_its_line),
      cmocka_unit_test(a_selection_needs_nodes),
      cmocka_unit_test(a_text_is_read_like_a_file),
      cmocka_unit_test(a_place_has_a_line),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
