/* cluster_joins.c - see cluster_joins.h. All pairs of neighbours of a thread are sorted
 * by how they meet; the way that saves the most visits is taken first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/cluster_joins.h"

#include <stdlib.h>
#include <string.h>

#include "kernels/cluster_shapes.h"

enum { NODES = CB_UNIT_NODES, TETS = CB_UNIT_TETS, FEWEST_SHARED = 3, ROUNDS = 2, HUB = 256 };
static const uint8_t OWN = 255; /* a node that only the second has */

/* How two units meet. */
struct meeting {
  uint32_t first, second; /* shapes */
  uint32_t part;          /* of both */
  uint8_t place[NODES];   /* node v of the second is node place[v] of the first, or OWN */
};

struct pair {
  uint64_t kind; /* a hash of the meeting */
  uint32_t first, second, saved;
};

/* Pairs first to last-1 meet in the same way. */
struct run {
  size_t first, last;
  uint64_t saved, apart; /* node visits; how far apart the two are in the mesh, in all */
};

struct work {
  const struct cb_mesh *mesh;
  const struct cb_clusters *clusters;
  struct cb_units *u;
  size_t begin, lanes;  /* units of the thread: from begin on */
  uint32_t *start, *at; /* of each node: units at[start[n]] to at[start[n+1]-1] */
  uint8_t *shared;      /* [units] nodes shared with the one that is looked at */
  uint32_t *near;       /* [units] those that share some */
  struct pair *pair;
  struct run *run;
  size_t pairs, room[2];
};

static size_t nodes_of(const struct work *w, const struct cb_unit *unit, uint32_t *node) {
  const struct cb_unit_shape *s = w->u->shape + unit->shape;
  for (size_t v = 0; v < s->nodes; v++)
    node[v] =
        w->clusters->node[CB_CLUSTER_NODES * (size_t)unit->cluster[s->node[v] / CB_CLUSTER_NODES] +
                          s->node[v] % CB_CLUSTER_NODES];
  return s->nodes;
}

/* ---- how two meet ---------------------------------------------------------------- */

static struct meeting meeting_of(const struct work *w, const struct cb_unit *a,
                                 const struct cb_unit *b) {
  struct meeting m = {a->shape, b->shape, a->part, {0}};
  uint32_t p[NODES], q[NODES];
  const size_t nodes = nodes_of(w, a, p), others = nodes_of(w, b, q);
  for (size_t v = 0; v < others; v++) {
    m.place[v] = OWN;
    for (size_t k = 0; k < nodes; k++)
      if (p[k] == q[v]) m.place[v] = (uint8_t)k;
  }
  return m;
}

static uint64_t hash(const struct meeting *m) {
  uint64_t words[sizeof *m / 8 + 1] = {0}, h = 0;
  memcpy(words, m, sizeof *m);
  for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
    h = (h ^ words[i]) * 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
  }
  return h;
}

/* Of the two ways to see a pair, that with the lower hash; exchanged: the second's. */
static struct meeting seen_from_either(const struct work *w, uint32_t a, uint32_t b,
                                       bool *exchanged) {
  const struct meeting there = meeting_of(w, w->u->unit + a, w->u->unit + b);
  const struct meeting back = meeting_of(w, w->u->unit + b, w->u->unit + a);
  *exchanged = hash(&back) < hash(&there);
  return *exchanged ? back : there;
}

/* ---- pairs ------------------------------------------------------------------------- */

static enum cb_status add_pair(struct work *w, uint32_t a, uint32_t b) {
  const struct cb_unit *p = w->u->unit + a, *q = w->u->unit + b;
  const struct cb_unit_shape *s = w->u->shape + p->shape, *t = w->u->shape + q->shape;
  const size_t shared = w->shared[b];
  if (shared < FEWEST_SHARED || s->nodes + t->nodes - shared > NODES || s->tets + t->tets > TETS ||
      p->clusters + q->clusters > CB_UNIT_CLUSTERS || p->part != q->part)
    return CB_OK;
  struct pair *pair = cb_grown(w->pair, &w->room[0], w->pairs + 1, sizeof *pair);
  if (!pair) return CB_MEMORY;
  w->pair = pair;
  bool exchanged;
  const struct meeting m = seen_from_either(w, a, b, &exchanged);
  w->pair[w->pairs++] =
      (struct pair){hash(&m), exchanged ? b : a, exchanged ? a : b, (uint32_t)shared};
  return CB_OK;
}

/* start, at: which units each node has. */
static void list_by_node(struct work *w) {
  uint32_t node[NODES];
  memset(w->start, 0, (w->mesh->nodes + 2) * sizeof *w->start);
  for (int pass = 0; pass < 2; pass++) {
    for (size_t i = w->begin; i < w->u->units; i++)
      for (size_t v = 0, n = nodes_of(w, w->u->unit + i, node); v < n; v++)
        if (pass == 0)
          w->start[node[v] + (size_t)2]++;
        else
          w->at[w->start[node[v] + (size_t)1]++] = (uint32_t)i;
    for (size_t n = 2; pass == 0 && n < w->mesh->nodes + 2; n++) w->start[n] += w->start[n - 1];
  }
}

static enum cb_status find_pairs(struct work *w) {
  w->pairs = 0;
  list_by_node(w);
  for (size_t a = w->begin; a < w->u->units; a++) {
    uint32_t node[NODES];
    size_t nears = 0;
    for (size_t v = 0, n = nodes_of(w, w->u->unit + a, node); v < n; v++) {
      const uint32_t first = w->start[node[v]], last = w->start[node[v] + (size_t)1];
      if (last - first > HUB) continue; /* the time must not grow with their square */
      for (uint32_t k = last; k-- > first && w->at[k] > a;)
        if (w->shared[w->at[k]]++ == 0) w->near[nears++] = w->at[k];
    }
    enum cb_status status = CB_OK;
    for (size_t i = 0; i < nears; i++) {
      if (!status) status = add_pair(w, (uint32_t)a, w->near[i]);
      w->shared[w->near[i]] = 0;
    }
    if (status) return status;
  }
  return CB_OK;
}

static int by_kind(const void *first, const void *second) {
  const struct pair *a = first, *b = second;
  if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
  const uint32_t p = a->first < a->second ? a->first : a->second;
  const uint32_t q = b->first < b->second ? b->first : b->second;
  if (p != q) return p < q ? -1 : 1;
  return (a->first + a->second > b->first + b->second) -
         (a->first + a->second < b->first + b->second);
}

static int by_saving(const void *first, const void *second) {
  const struct run *a = first, *b = second;
  if (a->saved != b->saved) return a->saved > b->saved ? -1 : 1;
  if (a->apart != b->apart) return a->apart < b->apart ? -1 : 1;
  return (a->first > b->first) - (a->first < b->first);
}

/* ---- joining ------------------------------------------------------------------------- */

static enum cb_status add_shape(struct cb_units *u, const struct cb_unit_shape *shape) {
  struct cb_unit_shape *grown = cb_grown(u->shape, &u->room, u->shapes + 1, sizeof *grown);
  if (!grown) return CB_MEMORY;
  u->shape = grown;
  u->shape[u->shapes++] = *shape;
  return CB_OK;
}

static struct cb_unit_shape joined_shape(const struct cb_units *u, const struct meeting *m,
                                         size_t clusters) {
  struct cb_unit_shape s = u->shape[m->first];
  const struct cb_unit_shape *t = u->shape + m->second;
  uint8_t place[NODES];
  for (size_t v = 0; v < t->nodes; v++) {
    place[v] = m->place[v];
    if (place[v] != OWN) continue;
    s.node[s.nodes] = (uint8_t)(t->node[v] + CB_CLUSTER_NODES * clusters);
    place[v] = s.nodes++;
  }
  for (size_t i = 0; i < t->tets; i++, s.tets++) {
    for (size_t j = 0; j < 4; j++) s.vertex[s.tets][j] = place[t->vertex[i][j]];
    s.tet[s.tets] = (uint8_t)(t->tet[i] + CB_CLUSTER_TETS * clusters);
  }
  return s;
}

/* The second becomes empty. */
static void join(struct cb_unit *a, struct cb_unit *b, uint32_t shape) {
  for (size_t k = 0; k < b->clusters; k++) a->cluster[a->clusters + k] = b->cluster[k];
  a->clusters = (uint8_t)(a->clusters + b->clusters);
  a->shape = shape;
  b->clusters = 0;
}

/* As many disjoint pairs of a run as fill whole packs. used[units] */
static enum cb_status join_run(struct work *w, const struct run *run, uint8_t *used) {
  struct cb_units *u = w->u;
  size_t count = 0;
  bool exchanged;
  struct meeting m = {0};
  struct pair *taken = w->pair + run->first; /* those taken, moved to the front */
  for (size_t i = run->first; i < run->last; i++) {
    const struct pair p = w->pair[i];
    if (used[p.first] || used[p.second]) continue;
    const struct meeting n = seen_from_either(w, p.first, p.second, &exchanged);
    if (count == 0) m = n;
    if (memcmp(&n, &m, sizeof m) != 0) continue;
    used[p.first] = used[p.second] = 1;
    taken[count++] = p;
  }
  const size_t kept = count / w->lanes * w->lanes;
  for (size_t i = kept; i < count; i++) used[taken[i].first] = used[taken[i].second] = 0;
  if (kept == 0) return CB_OK;
  const struct cb_unit_shape shape = joined_shape(u, &m, u->unit[taken->first].clusters);
  if (add_shape(u, &shape)) return CB_MEMORY;
  for (size_t i = 0; i < kept; i++)
    join(u->unit + taken[i].first, u->unit + taken[i].second, (uint32_t)u->shapes - 1);
  return CB_OK;
}

static uint32_t distance(const struct pair *p) {
  return p->first < p->second ? p->second - p->first : p->first - p->second;
}

/* Runs that may fill a pack, those that save the most first. */
static enum cb_status find_runs(struct work *w, size_t *runs) {
  *runs = 0;
  qsort(w->pair, w->pairs, sizeof *w->pair, by_kind);
  for (size_t i = 0, n; i < w->pairs; i = n) {
    uint64_t apart = 0;
    for (n = i; n < w->pairs && w->pair[n].kind == w->pair[i].kind; n++)
      apart += distance(w->pair + n);
    if (n - i < w->lanes) continue;
    struct run *run = cb_grown(w->run, &w->room[1], *runs + 1, sizeof *run);
    if (!run) return CB_MEMORY;
    w->run = run;
    w->run[(*runs)++] = (struct run){i, n, (uint64_t)(n - i) * w->pair[i].saved, apart};
  }
  if (*runs) qsort(w->run, *runs, sizeof *w->run, by_saving);
  return CB_OK;
}

static enum cb_status join_thread(struct work *w) {
  struct cb_units *u = w->u;
  for (int round = 0; round < ROUNDS; round++) {
    size_t runs;
    if (find_pairs(w)) return CB_MEMORY;
    if (w->pairs == 0 || find_runs(w, &runs)) return w->pairs == 0 ? CB_OK : CB_MEMORY;
    uint8_t *used = w->shared; /* all zero */
    enum cb_status status = CB_OK;
    for (size_t i = 0; i < runs && !status && u->shapes < UINT16_MAX; i++)
      status = join_run(w, w->run + i, used);
    memset(used, 0, u->units);
    if (status) return status;
    const size_t before = u->units;
    u->units = w->begin;
    for (size_t i = w->begin; i < before; i++)
      if (u->unit[i].clusters) u->unit[u->units++] = u->unit[i];
    if (u->units == before) return CB_OK;
  }
  return CB_OK;
}

/* ---- all -------------------------------------------------------------------------------- */

static enum cb_status add_cluster_shapes(const struct cb_clusters *c, struct cb_units *u) {
  for (size_t t = 0; t < c->templates; t++) {
    struct cb_unit_shape s = {c->shape[t].nodes, c->shape[t].tets, {0}, {0}, {{0}}};
    for (uint8_t v = 0; v < s.nodes; v++) s.node[v] = v;
    for (uint8_t i = 0; i < s.tets; i++) {
      for (size_t j = 0; j < 4; j++) s.vertex[i][j] = c->shape[t].vertex[i][j];
      s.tet[i] = i;
    }
    if (add_shape(u, &s)) return CB_MEMORY;
  }
  return CB_OK;
}

enum cb_status cb_units_create(const struct cb_mesh *mesh, const struct cb_clusters *clusters,
                               const uint8_t *thread, const uint8_t *part, size_t lanes,
                               size_t threads, bool joined, struct cb_units *out) {
  const size_t n = clusters->clusters + 1;
  struct cb_units made = {.unit = malloc(n * sizeof *made.unit)};
  struct work w = {.mesh = mesh,
                   .clusters = clusters,
                   .u = &made,
                   .lanes = lanes,
                   .start = malloc((mesh->nodes + 2) * sizeof *w.start),
                   .at = malloc(n * CB_CLUSTER_NODES * sizeof *w.at),
                   .shared = calloc(n, 1),
                   .near = malloc(n * sizeof *w.near)};
  enum cb_status status = CB_MEMORY;
  if (made.unit && w.start && w.at && w.shared && w.near)
    status = add_cluster_shapes(clusters, &made);
  for (size_t t = 0; t < threads && !status; t++) {
    w.begin = made.units;
    for (size_t s = 0; s < clusters->templates; s++)
      for (size_t c = clusters->first[s]; c < clusters->first[s + 1]; c++)
        if (thread[c] == t)
          made.unit[made.units++] =
              (struct cb_unit){{(uint32_t)c}, (uint32_t)s, 1, (uint8_t)t, part[c]};
    if (joined) status = join_thread(&w);
  }
  free(w.start);
  free(w.at);
  free(w.shared);
  free(w.near);
  free(w.pair);
  free(w.run);
  if (status)
    cb_units_free(&made);
  else
    *out = made;
  return status;
}

void cb_units_free(struct cb_units *u) {
  free(u->shape);
  free(u->unit);
  *u = (struct cb_units){0};
}
