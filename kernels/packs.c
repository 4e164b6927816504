/* SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/packs.h"

#include <stdlib.h>
#include <string.h>

#include "kernels/memory.h"
#include "kernels/team.h"

/* Units of one mesh: tetrahedra, or clusters, which are joined once they have their
 * threads. In the order of their lowest tetrahedra within a shape. */
struct units {
  const struct cb_mesh *mesh;
  const struct cb_clusters *clusters; /* NULL: each tetrahedron is one */
  struct cb_units joined;             /* zeroed: each cluster is one */
  size_t count, shapes;
  uint32_t *sorted; /* [count] joined: by thread, shape and part, */
  uint32_t *first;  /* [threads * shapes * 3 + 1] where those of each begin */
  uint8_t *thread;  /* [count] whose chunk */
  uint8_t *part;    /* [count] 0, 1, 2 as above */
  uint64_t *users;  /* [nodes] threads whose units have the node; NULL: one thread */
};

static size_t nodes_in(const struct units *U, size_t shape) {
  if (U->joined.unit) return U->joined.shape[shape].nodes;
  return U->clusters ? U->clusters->shape[shape].nodes : 4;
}

static size_t tets_in(const struct units *U, size_t shape) {
  if (U->joined.unit) return U->joined.shape[shape].tets;
  return U->clusters ? U->clusters->shape[shape].tets : 1;
}

/* Before they are joined. */
static size_t first_of(const struct units *U, size_t shape) {
  return U->clusters ? U->clusters->first[shape] : shape == 0 ? 0 : U->count;
}

static uint32_t node_of(const struct units *U, size_t unit, size_t j) {
  if (!U->clusters) return U->mesh->tet[4 * unit + j];
  if (!U->joined.unit) return U->clusters->node[CB_CLUSTER_NODES * unit + j];
  const struct cb_unit *u = U->joined.unit + unit;
  const size_t source = U->joined.shape[u->shape].node[j];
  const size_t cluster = u->cluster[source / CB_CLUSTER_NODES];
  return U->clusters->node[CB_CLUSTER_NODES * cluster + source % CB_CLUSTER_NODES];
}

/* Place of the unit's tetrahedron in the clusters' arrays. */
static size_t place_of(const struct units *U, size_t unit, size_t i) {
  if (!U->joined.unit) return CB_CLUSTER_TETS * unit + i;
  const struct cb_unit *u = U->joined.unit + unit;
  const size_t source = U->joined.shape[u->shape].tet[i];
  return CB_CLUSTER_TETS * (size_t)u->cluster[source / CB_CLUSTER_TETS] + source % CB_CLUSTER_TETS;
}

static uint32_t lowest_tet(const struct units *U, size_t unit, size_t tets) {
  uint32_t lowest = UINT32_MAX;
  for (size_t i = 0; i < tets; i++) {
    const uint32_t t = U->clusters ? U->clusters->tet[place_of(U, unit, i)] : (uint32_t)unit;
    if (t < lowest) lowest = t;
  }
  return lowest;
}

/* Chunks are equal numbers of tetrahedra, in the order of the mesh. */
static void give_to_threads(struct units *U, size_t threads, const uint8_t *shape,
                            uint32_t *unit_at) {
  const size_t tets = U->mesh->tets;
  for (size_t t = 0; t < tets; t++) unit_at[t] = UINT32_MAX;
  for (size_t u = 0; u < U->count; u++) unit_at[lowest_tet(U, u, shape[u])] = (uint32_t)u;
  for (size_t t = 0, done = 0; t < tets; t++)
    if (unit_at[t] != UINT32_MAX) {
      const size_t u = unit_at[t];
      U->thread[u] = (uint8_t)((done + shape[u] / 2) * threads / tets);
      done += shape[u];
    }
}

static uint64_t bit(size_t thread) { return (uint64_t)1 << thread; }

/* Threads that have one of the unit's nodes as well. */
static uint64_t sharers(const struct units *U, size_t unit, size_t nodes) {
  uint64_t all = 0;
  for (size_t j = 0; j < nodes; j++) all |= U->users[node_of(U, unit, j)];
  return all & ~bit(U->thread[unit]);
}

static enum cb_status distribute(struct units *U, size_t threads) {
  enum cb_status status = CB_MEMORY;
  U->thread = calloc(U->count, 1);
  U->part = malloc(U->count);
  uint8_t *tets = malloc(U->count);
  uint32_t *unit_at = malloc(U->mesh->tets * sizeof *unit_at);
  if (threads > 1) U->users = calloc(U->mesh->nodes, sizeof *U->users);
  if (!U->thread || !U->part || !tets || !unit_at || (threads > 1 && !U->users)) goto done;
  memset(U->part, 1, U->count);
  status = CB_OK;
  if (threads == 1) goto done;
  for (size_t s = 0; s < U->shapes; s++)
    memset(tets + first_of(U, s), (int)tets_in(U, s), first_of(U, s + 1) - first_of(U, s));
  give_to_threads(U, threads, tets, unit_at);
  for (size_t s = 0; s < U->shapes; s++)
    for (size_t u = first_of(U, s); u < first_of(U, s + 1); u++)
      for (size_t j = 0; j < nodes_in(U, s); j++) U->users[node_of(U, u, j)] |= bit(U->thread[u]);
  for (size_t s = 0; s < U->shapes; s++)
    for (size_t u = first_of(U, s); u < first_of(U, s + 1); u++) {
      const uint64_t others = sharers(U, u, nodes_in(U, s));
      if (others) U->part[u] = others >= bit(U->thread[u]) ? 0 : 2;
    }
done:
  free(tets);
  free(unit_at);
  return status;
}

static size_t drawer(const struct units *U, size_t thread, size_t shape, size_t part) {
  return (thread * U->shapes + shape) * 3 + part;
}

/* The clusters of each thread as units, joined or not. */
static enum cb_status join(struct units *U, size_t lanes, size_t threads, bool joined) {
  struct cb_units *J = &U->joined;
  if (cb_units_create(U->mesh, U->clusters, U->thread, U->part, lanes, threads, joined, J))
    return CB_MEMORY;
  U->count = J->units, U->shapes = J->shapes;
  const size_t drawers = threads * U->shapes * 3;
  U->sorted = malloc(U->count * sizeof *U->sorted);
  U->first = calloc(drawers + 2, sizeof *U->first);
  if (!U->sorted || !U->first) return CB_MEMORY;
  for (size_t u = 0; u < U->count; u++) {
    U->thread[u] = J->unit[u].thread, U->part[u] = J->unit[u].part;
    U->first[drawer(U, U->thread[u], J->unit[u].shape, U->part[u]) + 2]++;
  }
  for (size_t i = 2; i < drawers + 2; i++) U->first[i] += U->first[i - 1];
  for (size_t u = 0; u < U->count; u++)
    U->sorted[U->first[drawer(U, U->thread[u], J->unit[u].shape, U->part[u]) + 1]++] = (uint32_t)u;
  return CB_OK;
}

/* A pack before it has its place. */
struct draft {
  uint32_t unit[CB_LANES_MOST];
  uint32_t position; /* lowest tetrahedron of its first unit */
  uint32_t sequence;
  uint16_t shape;
  uint8_t part, live;
};

struct drafts {
  struct draft *draft;
  size_t count, room;
};

static bool grow(struct drafts *d) {
  if (d->count < d->room) return true;
  const size_t room = 2 * d->room + 64;
  struct draft *larger = realloc(d->draft, room * sizeof *larger);
  if (!larger) return false;
  d->draft = larger, d->room = room;
  return true;
}

/* Single tetrahedra of one pack are so far apart in the list: neighbours share nodes,
 * and adding to a node that has just been added to waits for it. Clusters have
 * nothing to gain from that: they add to a node once. */
static const size_t APART = 16;

/* list[count] := units list[count] with each LANES * APART of them turned from rows
 * into columns; what is left at the end stays. copy[count] is for work. */
static void spread(size_t lanes, size_t count, uint32_t *list, uint32_t *copy) {
  const size_t block = lanes * APART;
  memcpy(copy, list, count * sizeof *list);
  for (size_t b = 0; lanes > 1 && b + block <= count; b += block)
    for (size_t i = 0; i < block; i++) list[b + i] = copy[b + i % lanes * APART + i / lanes];
}

/* A thread's units of one shape, those of part 0 first, those of part 2 last, into
 * list[2 * units]; returns how many. The second half is for work. */
static size_t list_units(const struct units *U, size_t lanes, size_t thread, size_t shape,
                         uint32_t *list) {
  size_t count = 0;
  if (U->sorted) {
    const size_t first = U->first[drawer(U, thread, shape, 0)];
    count = U->first[drawer(U, thread, shape + 1, 0)] - first;
    memcpy(list, U->sorted + first, count * sizeof *list);
    return count;
  }
  for (int part = 0; part < 3; part++) {
    const size_t first = count;
    for (size_t u = 0; u < U->count; u++)
      if (U->thread[u] == thread && U->part[u] == part) list[count++] = (uint32_t)u;
    spread(lanes, count - first, list + first, list + U->count);
  }
  return count;
}

/* A pack of mixed parts belongs to 0 if one of its units does, else to 2. */
static bool draft_shape(const struct units *U, size_t lanes, size_t shape, size_t count,
                        const uint32_t *list, struct drafts *d) {
  for (size_t i = 0; i < count; i += lanes) {
    if (!grow(d)) return false;
    struct draft *pack = &d->draft[d->count++];
    *pack = (struct draft){.shape = (uint16_t)shape, .part = 1, .sequence = (uint32_t)d->count};
    pack->live = (uint8_t)(count - i < lanes ? count - i : lanes);
    pack->position = lowest_tet(U, list[i], tets_in(U, shape));
    for (size_t l = 0; l < lanes; l++) {
      pack->unit[l] = list[i + (l < pack->live ? l : pack->live - 1u)];
      const uint8_t part = U->part[pack->unit[l]];
      if (part != 1 && pack->part != 0) pack->part = part;
    }
  }
  return true;
}

/* Packs of a region follow each other, by shape within it: the next loop counts are
 * then the last ones, and a region's nodes fit the cache. */
static const uint32_t REGION = 4096; /* tetrahedra */

static int by_place(const void *first, const void *second) {
  const struct draft *a = first, *b = second;
  if (a->part != b->part) return a->part - b->part;
  const uint32_t p = a->position / REGION, q = b->position / REGION;
  if (p != q) return p < q ? -1 : 1;
  if (a->shape != b->shape) return a->shape - b->shape;
  return (a->position > b->position) - (a->position < b->position);
}

/* Single elements: the pack that is not full stays the last of its chunk. */
static int by_part(const void *first, const void *second) {
  const struct draft *a = first, *b = second;
  if (a->part != b->part) return a->part - b->part;
  return (a->sequence > b->sequence) - (a->sequence < b->sequence);
}

/* Chunk of one thread: its packs are the drafts from `first` on. */
static void make_chunk(const struct units *U, size_t thread, size_t first, const struct drafts *d,
                       struct cb_chunk *c) {
  *c = (struct cb_chunk){.part = {first, d->count, first, d->count}};
  size_t part[3] = {0};
  for (size_t i = first; i < d->count; i++) {
    const struct draft *p = &d->draft[i];
    part[p->part]++;
    if (p->part == 1) continue;
    for (size_t l = 0; l < p->live; l++)
      c->after[p->part / 2] |= sharers(U, p->unit[l], nodes_in(U, p->shape)) & (bit(thread) - 1);
  }
  for (size_t k = 0, at = first; k < 3; k++) c->part[k] = at, at += part[k];
  c->last_live = d->count > first ? d->draft[d->count - 1].live : 0;
}

static enum cb_status draft_packs(const struct units *U, struct cb_packs *P, struct drafts *d) {
  uint32_t *list = malloc(2 * U->count * sizeof *list + 1);
  bool room = list != NULL;
  for (size_t t = 0; room && t < P->threads; t++) {
    const size_t first = d->count;
    for (size_t s = 0; room && s < U->shapes; s++) {
      const size_t count = list_units(U, P->lanes, t, s, list);
      room = draft_shape(U, P->lanes, s, count, list, d);
    }
    if (d->count > first)
      qsort(d->draft + first, d->count - first, sizeof *d->draft, U->clusters ? by_place : by_part);
    make_chunk(U, t, first, d, &P->chunk[t]);
  }
  free(list);
  return room ? CB_OK : CB_MEMORY;
}

/* Copy what the drafts say into the arrays. */
static bool fill(const struct units *U, const struct drafts *d, struct cb_packs *P) {
  bool ordered = true;
  for (size_t p = 0, node = 0, slot = 0; p < d->count; p++) {
    const struct draft *draft = &d->draft[p];
    const size_t nodes = nodes_in(U, draft->shape), tets = tets_in(U, draft->shape);
    if (P->pack)
      P->pack[p] = (struct cb_pack){(uint32_t)node, (uint32_t)slot, draft->shape, draft->live};
    for (size_t l = 0; l < P->lanes; l++) {
      const size_t u = draft->unit[l];
      for (size_t j = 0; j < nodes; j++) P->node[(node + j) * P->lanes + l] = node_of(U, u, j);
      for (size_t i = 0; P->order && i < tets; i++) {
        const uint8_t *own = cb_permutation[U->clusters->order[place_of(U, u, i)]];
        const uint8_t code = (uint8_t)(own[0] | own[1] << 2 | own[2] << 4 | own[3] << 6);
        P->order[(slot + i) * P->lanes + l] = code;
        ordered = ordered && code == (0 | 1 << 2 | 2 << 4 | 3 << 6);
      }
    }
    node += nodes, slot += tets;
  }
  return ordered;
}

static struct cb_corners corners_of(const uint8_t *vertex, uint32_t *met) {
  struct cb_corners c;
  for (size_t j = 0; j < 4; j++) {
    c.vertex[j] = vertex[j];
    c.sum[j] = *met >> vertex[j] & 1 ? vertex[j] : CB_UNIT_NODES;
    *met |= (uint32_t)1 << vertex[j];
  }
  return c;
}

static enum cb_status fill_shapes(const struct cb_units *J, struct cb_packs *P) {
  for (size_t s = 0; s < J->shapes; s++) P->all_corners += J->shape[s].tets;
  P->shape = malloc(J->shapes * sizeof *P->shape);
  P->corners = malloc(P->all_corners * sizeof *P->corners);
  P->bytes += J->shapes * sizeof *P->shape + P->all_corners * sizeof *P->corners;
  if (!P->shape || !P->corners) return CB_MEMORY;
  for (size_t s = 0, at = 0; s < J->shapes; s++) {
    const struct cb_unit_shape *shape = J->shape + s;
    uint32_t met = 0;
    P->shape[s] = (struct cb_pack_shape){shape->nodes, shape->tets, (uint32_t)at};
    for (size_t i = 0; i < shape->tets; i++) P->corners[at++] = corners_of(shape->vertex[i], &met);
  }
  return CB_OK;
}

static enum cb_status allocate(const struct units *U, const struct drafts *d, struct cb_packs *P) {
  P->packs = d->count;
  for (size_t p = 0; p < d->count; p++) {
    P->nodes += nodes_in(U, d->draft[p].shape);
    P->slots += tets_in(U, d->draft[p].shape);
  }
  if (P->nodes * P->lanes > UINT32_MAX) return CB_INPUT;
  P->node = cb_memory(P->nodes * P->lanes, sizeof *P->node);
  P->bytes = P->nodes * P->lanes * sizeof *P->node + P->threads * sizeof *P->chunk;
  if (!P->node) return CB_MEMORY;
  if (!U->clusters) return CB_OK;
  P->pack = malloc(P->packs * sizeof *P->pack);
  P->order = malloc(P->slots * P->lanes);
  P->bytes += P->packs * sizeof *P->pack + P->slots * P->lanes;
  if (!P->pack || !P->order) return CB_MEMORY;
  return fill_shapes(&U->joined, P);
}

enum cb_status cb_packs_create(const struct cb_mesh *mesh, size_t lanes, size_t threads,
                               bool clustered, bool joined, struct cb_packs **out) {
  struct units U = {.mesh = mesh, .count = mesh->tets, .shapes = 1};
  struct drafts d = {0};
  struct cb_clusters *clusters = NULL;
  enum cb_status status = CB_MEMORY;
  struct cb_packs *P = calloc(1, sizeof *P);
  if (!P) return CB_MEMORY;
  P->lanes = lanes, P->threads = threads;
  P->chunk = calloc(threads, sizeof *P->chunk);
  if (!P->chunk) goto done;
  status = clustered ? cb_clusters_create(mesh, lanes, &clusters) : CB_OK;
  if (status) goto done;
  if (clusters) U.clusters = clusters, U.count = clusters->clusters, U.shapes = clusters->templates;
  status = distribute(&U, threads);
  if (!status && clusters) status = join(&U, lanes, threads, joined);
  if (!status) status = draft_packs(&U, P, &d);
  if (!status) status = allocate(&U, &d, P);
  if (status) goto done;
  const bool ordered = fill(&U, &d, P);
  if (ordered) cb_packs_disorder(P);
  *out = P;
  P = NULL;
done:
  free(d.draft);
  free(U.thread);
  free(U.part);
  free(U.users);
  free(U.sorted);
  free(U.first);
  cb_units_free(&U.joined);
  cb_clusters_free(clusters);
  cb_packs_free(P);
  return status;
}

void cb_packs_disorder(struct cb_packs *P) {
  if (P->order) P->bytes -= P->slots * P->lanes;
  free(P->order);
  P->order = NULL;
}

void cb_packs_free(struct cb_packs *P) {
  if (!P) return;
  free(P->node);
  free(P->chunk);
  free(P->pack);
  free(P->shape);
  free(P->corners);
  free(P->order);
  free(P);
}
