/* cluster_shapes.c - the canonical numbering of a small cluster by branch and bound;
 * a hash table saves doing that again.
 * Source: the idea of McKay 1981, without refinement: eight nodes do not need it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/cluster_shapes.h"

#include <stdlib.h>
#include <string.h>

enum { NODES = CB_CLUSTER_NODES, TETS = CB_CLUSTER_TETS, NUMBERINGS = 48, FEW = 64 };
static const uint32_t NONE = UINT32_MAX;

/* ---- canonical numbering ------------------------------------------------------- */

enum { PART = NODES + TETS + 1, CODE = NODES * (NODES + 3) / 2 + TETS };

/* The code of a numbering, node by node: in how many tetrahedra the node is, and is
 * together with each one before; the tetrahedra that it completes, low ones first;
 * a zero. The canonical numberings have the greatest code. Without the counts it
 * would still be one, but a search took ten times as long. */
struct canon {
  const uint8_t *mask;
  size_t nodes, tets;
  uint8_t together[NODES][NODES];
  uint8_t node[NODES], place[NODES]; /* those numbered so far, and their numbers */
  uint8_t code[CODE], best[CODE];
  struct cb_numbering numbering[NUMBERINGS]; /* those with the best code */
  size_t numberings;
};

static uint8_t renumbered(uint8_t mask, const uint8_t *place) {
  unsigned m = 0;
  for (size_t v = 0; v < NODES; v++)
    if (mask >> v & 1) m |= 1u << place[v];
  return (uint8_t)m;
}

/* part[PART], zeros, := what node v adds to the code as number n; returns its length. */
static size_t code_part(struct canon *c, unsigned numbered, size_t n, size_t v, uint8_t *part) {
  struct cb_masks completed;
  size_t length = 0;
  part[0] = c->together[v][v];
  for (size_t i = 0; i < n; i++) part[1 + i] = c->together[v][c->node[i]];
  c->place[v] = (uint8_t)n;
  numbered |= 1u << v;
  for (size_t i = 0; i < c->tets; i++)
    if (c->mask[i] >> v & 1 && (c->mask[i] & ~numbered) == 0)
      cb_masks_insert(&completed, length++, renumbered(c->mask[i], c->place));
  for (size_t i = 0; i < length; i++) part[1 + n + i] = (uint8_t)~completed.of[i];
  return 1 + n + length + 1;
}

static void keep_numbering(struct canon *c, size_t length) {
  if (memcmp(c->code, c->best, length) > 0) {
    memcpy(c->best, c->code, length);
    c->numberings = 0;
  }
  if (c->numberings < NUMBERINGS)
    memcpy(c->numbering[c->numberings++].place, c->place, sizeof c->place);
}

/* All ways to number the rest that may have the greatest code; n nodes are numbered. */
static void number_rest(struct canon *c, unsigned numbered, size_t n, size_t length) {
  uint8_t part[NODES][PART] = {{0}};
  size_t size[NODES] = {0}, greatest = NODES;
  if (n == c->nodes) {
    keep_numbering(c, length);
    return;
  }
  for (size_t v = 0; v < c->nodes; v++) {
    if (numbered >> v & 1) continue;
    size[v] = code_part(c, numbered, n, v, part[v]);
    if (greatest == NODES || memcmp(part[v], part[greatest], PART) > 0) greatest = v;
  }
  memcpy(c->code + length, part[greatest], size[greatest]);
  for (size_t v = 0; v < c->nodes; v++) {
    if (numbered >> v & 1 || memcmp(part[v], part[greatest], PART) != 0) continue;
    if (memcmp(c->code, c->best, length + size[v]) < 0) return;
    c->node[n] = (uint8_t)v;
    c->place[v] = (uint8_t)n;
    number_rest(c, numbered | 1u << v, n + 1, length + size[v]);
  }
}

static void renumber(const struct cb_masks *masks, const uint8_t *place, struct cb_masks *out) {
  *out = (struct cb_masks){{0}};
  for (size_t i = 0; i < TETS && masks->of[i]; i++)
    cb_masks_insert(out, i, renumbered(masks->of[i], place));
}

static void number_canonically(const struct cb_masks *masks, struct canon *c) {
  *c = (struct canon){.mask = masks->of};
  for (; c->tets < TETS && masks->of[c->tets]; c->tets++)
    for (size_t v = 0; v < NODES; v++)
      for (size_t u = 0; u < NODES; u++)
        c->together[v][u] += masks->of[c->tets] >> v & masks->of[c->tets] >> u & 1;
  while (c->nodes < NODES && c->together[c->nodes][c->nodes]) c->nodes++;
  number_rest(c, 0, 0, 0);
}

/* ---- the table ------------------------------------------------------------------- */

static uint64_t hash(const struct cb_masks *masks) {
  uint64_t a;
  uint32_t b;
  memcpy(&a, masks->of, sizeof a);
  memcpy(&b, masks->of + sizeof a, sizeof b);
  a = (a ^ b * 0x9E3779B97F4A7C15u) * 0xBF58476D1CE4E5B9u;
  return a ^ a >> 29;
}

/* The slot of that cluster, or the empty one where it belongs. */
static uint32_t *slot_of(const struct cb_shapes *s, const struct cb_masks *masks) {
  for (size_t i = hash(masks) & (s->slots - 1);; i = (i + 1) & (s->slots - 1))
    if (s->slot[i] == NONE || memcmp(&s->cluster[s->slot[i]].masks, masks, sizeof *masks) == 0)
      return s->slot + i;
}

enum cb_status cb_shapes_create(struct cb_shapes *s) {
  *s = (struct cb_shapes){.slots = FEW, .slot = malloc(FEW * sizeof *s->slot)};
  if (!s->slot) return CB_MEMORY;
  for (size_t i = 0; i < FEW; i++) s->slot[i] = NONE;
  return CB_OK;
}

void cb_shapes_free(struct cb_shapes *s) {
  free(s->shape);
  free(s->cluster);
  free(s->numbering);
  free(s->slot);
  *s = (struct cb_shapes){0};
}

/* Twice the slots, once half of them are used. */
static enum cb_status more_slots(struct cb_shapes *s) {
  if (2 * s->known < s->slots) return CB_OK;
  uint32_t *slot = malloc(2 * s->slots * sizeof *slot);
  if (!slot) return CB_MEMORY;
  free(s->slot);
  s->slot = slot;
  s->slots *= 2;
  for (size_t i = 0; i < s->slots; i++) slot[i] = NONE;
  for (size_t i = 0; i < s->known; i++) *slot_of(s, &s->cluster[i].masks) = (uint32_t)i;
  return CB_OK;
}

/* Room for one more cluster with that many numberings, of a new shape. */
static enum cb_status more_entries(struct cb_shapes *s, size_t numberings) {
  struct cb_masks *shape = cb_grown(s->shape, &s->room[0], s->shapes + 1, sizeof *shape);
  if (shape) s->shape = shape;
  struct cb_numbered *cluster = cb_grown(s->cluster, &s->room[1], s->known + 1, sizeof *cluster);
  if (cluster) s->cluster = cluster;
  struct cb_numbering *numbering =
      cb_grown(s->numbering, &s->room[2], s->numberings + numberings, sizeof *numbering);
  if (numbering) s->numbering = numbering;
  return shape && cluster && numbering ? CB_OK : CB_MEMORY;
}

enum cb_status cb_shapes_find(struct cb_shapes *s, const struct cb_masks *masks,
                              const struct cb_numbered **found) {
  const uint32_t known = *slot_of(s, masks);
  if (known != NONE) {
    *found = s->cluster + known;
    return CB_OK;
  }
  struct canon c;
  struct cb_masks shape;
  number_canonically(masks, &c);
  renumber(masks, c.numbering[0].place, &shape);
  const bool is_shape = memcmp(&shape, masks, sizeof shape) == 0;
  const struct cb_numbered *itself = NULL;
  if (!is_shape && cb_shapes_find(s, &shape, &itself)) return CB_MEMORY;
  const struct cb_numbered made = {.masks = *masks,
                                   .shape = is_shape ? (uint32_t)s->shapes : itself->shape,
                                   .first = (uint32_t)s->numberings,
                                   .numberings = (uint32_t)c.numberings};
  if (more_slots(s) || more_entries(s, c.numberings)) return CB_MEMORY;
  if (is_shape) s->shape[s->shapes++] = shape;
  memcpy(s->numbering + s->numberings, c.numbering, c.numberings * sizeof *c.numbering);
  s->numberings += c.numberings;
  s->cluster[s->known] = made;
  *slot_of(s, masks) = (uint32_t)s->known;
  *found = s->cluster + s->known++;
  return CB_OK;
}
