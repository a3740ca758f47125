/* loops_text.h: the loops of loops.h, compiled once per instruction set: RENDER_LOOPS names the table.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "render/light_node.h"
#include "render/loops.h"
#include "render/sampler_point.h"
#include "render/stages.h"
#if defined(__AVX2__)
#include <immintrin.h>
#endif

enum { BLOCK = LOOP_LANES };

/* Over the elements of a block that are there, in whole vectors. */
#define EACH_LANE(i) _Pragma("omp simd") for (size_t i = 0; i < BLOCK; i++)

/* ---- Moving elements ----------------------------------------------------------------------------------------- */

/* For every set m of the numbers below 8: ranks[m], whose byte i tells how many of the set are below i, and members[m],
 * whose bytes are those of the set in order. */
#define HAS(m, i) ((uint64_t)(m) >> (i)&1)
#define RANK(m, i)                                                                                                     \
    (HAS(m, 0)*((i) > 0) + HAS(m, 1)*((i) > 1) + HAS(m, 2)*((i) > 2) + HAS(m, 3)*((i) > 3) +                           \
     HAS(m, 4)*((i) > 4) + HAS(m, 5)*((i) > 5) + HAS(m, 6)*((i) > 6))
#define RANKS(m)                                                                                                       \
    (RANK(m, 1) << 8 | RANK(m, 2) << 16 | RANK(m, 3) << 24 | RANK(m, 4) << 32 | RANK(m, 5) << 40 | RANK(m, 6) << 48 |  \
     RANK(m, 7) << 56)
#define MEMBER(m, i) (HAS(m, i)*(i) << 8*RANK(m, i))
#define MEMBERS(m)                                                                                                     \
    (MEMBER(m, 1) | MEMBER(m, 2) | MEMBER(m, 3) | MEMBER(m, 4) | MEMBER(m, 5) | MEMBER(m, 6) | MEMBER(m, 7))
#define FOUR_OF(f, m) f(m), f((m) + 1), f((m) + 2), f((m) + 3)
#define SIXTEEN_OF(f, m) FOUR_OF(f, m), FOUR_OF(f, (m) + 4), FOUR_OF(f, (m) + 8), FOUR_OF(f, (m) + 12)
#define ROWS_OF(f, m) SIXTEEN_OF(f, m), SIXTEEN_OF(f, (m) + 16), SIXTEEN_OF(f, (m) + 32), SIXTEEN_OF(f, (m) + 48)
#define ALL_OF(f) ROWS_OF(f, 0), ROWS_OF(f, 64), ROWS_OF(f, 128), ROWS_OF(f, 192)
static const uint64_t ranks[256] = {ALL_OF(RANKS)}, members[256] = {ALL_OF(MEMBERS)};

/* The set of those for which keeps is 1, not 0. */
static inline uint32_t set_of(const uint32_t *keeps)
{
#if defined(__AVX2__)
    const __m256i all = _mm256_loadu_si256((const __m256i *)(const void *)keeps);
    return (uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_slli_epi32(all, 31)));
#else
    uint32_t set = 0;
    for (uint32_t i = 0; i < PACKED; i++) set |= keeps[i] << i;
    return set;
#endif
}

static inline void write_places(uint64_t bytes, uint32_t *places)
{
#if defined(__AVX2__)
    _mm256_storeu_si256((__m256i *)(void *)places, _mm256_cvtepu8_epi32(_mm_cvtsi64_si128((long long)bytes)));
#else
    for (int i = 0; i < PACKED; i++) places[i] = bytes >> 8*i & 0xff;
#endif
}

/* to[i] = from[places[i]] for all of them. */
static inline void pick(const void *from, const uint32_t *places, void *to)
{
#if defined(__AVX2__)
    const __m256i all = _mm256_loadu_si256((const __m256i *)from),
                  lanes = _mm256_loadu_si256((const __m256i *)(const void *)places);
    _mm256_storeu_si256((__m256i *)to, _mm256_permutevar8x32_epi32(all, lanes));
#else
    for (size_t i = 0; i < PACKED; i++) memcpy((char *)to + 4*i, (const char *)from + 4*places[i], 4);
#endif
}

static uint32_t pack(uint32_t n, const uint32_t *starts, const uint32_t *keeps, size_t n_arrays,
                     const packed_array *arrays)
{
    uint32_t places[PATHS], start[PATHS/PACKED], begin[PATHS/PACKED], n_kept = 0;
    for (uint32_t first = 0; first < n; first += PACKED) {
        const uint32_t from = starts ? starts[first/PACKED] : first;
        const uint32_t set = set_of(keeps + from) & (n - first < PACKED ? (1u << (n - first)) - 1 : 255);
        write_places(members[set], places + first);
        start[first/PACKED] = from;
        begin[first/PACKED] = n_kept;
        n_kept += (uint32_t)__builtin_popcount(set);
    }
    for (size_t k = 0; k < n_arrays; k += 4) { /* four at once, of which the last may be one array more than once */
        const packed_array *a = &arrays[k], *b = a + (k + 1 < n_arrays), *c = b + (k + 2 < n_arrays),
                           *d = c + (k + 3 < n_arrays);
        const char *const from[4] = {a->from, b->from, c->from, d->from};
        char *const to[4] = {a->to, b->to, c->to, d->to};
        for (uint32_t first = 0; first < n; first += PACKED) {
            const size_t source = 4*(size_t)start[first/PACKED], target = 4*(size_t)begin[first/PACKED];
            for (int i = 0; i < 4; i++) pick(from[i] + source, places + first, to[i] + target);
        }
    }
    return n_kept;
}

static void unpack(uint32_t n, const uint32_t *starts, const uint32_t *packed, uint32_t *keeps)
{
    for (uint32_t first = 0, n_before = 0; first < n; first += PACKED) {
        uint32_t places[PACKED], values[PACKED], *to = keeps + starts[first/PACKED];
        const uint32_t set = set_of(to);
        write_places(ranks[set], places);
        pick(packed + n_before, places, values);
        for (int i = 0; i < PACKED; i++) to[i] &= values[i];
        n_before += (uint32_t)__builtin_popcount(set);
    }
}

/* ---- Rays against a list ------------------------------------------------------------------------------------- */

/* A block's rays, and the nearest hit so far. */
typedef struct ray_block {
    float ox[BLOCK], oy[BLOCK], oz[BLOCK], dx[BLOCK], dy[BLOCK], dz[BLOCK], t_min[BLOCK];
    float t[BLOCK], u[BLOCK], v[BLOCK]; /* t: t_max at first */
    uint32_t which[BLOCK];              /* of the list, triangles first, or NO_HIT */
} ray_block;

static inline int is_small(float coordinate)
{
    return kabs(coordinate) < 1e18f;
}

/* Rays that cannot be traced, as tracer.h says, meet nothing: their t is below t_min. */
static void load_rays(ray_block *b, rays r, size_t first)
{
    const vectors o = r.origin, d = r.direction;
    EACH_LANE(i)
    {
        const size_t k = first + i;
        b->ox[i] = o.x[k];
        b->oy[i] = o.y[k];
        b->oz[i] = o.z[k];
        b->dx[i] = d.x[k];
        b->dy[i] = d.y[k];
        b->dz[i] = d.z[k];
        b->t_min[i] = r.t_min[k];
        const int is_finite = is_small(o.x[k]) & is_small(o.y[k]) & is_small(o.z[k]) & is_small(d.x[k]) &
                              is_small(d.y[k]) & is_small(d.z[k]) & (r.t_min[k] >= 0);
        b->t[i] = is_finite ? r.t_max[k] : -1.0f;
        b->u[i] = b->v[i] = 0;
        b->which[i] = NO_HIT;
    }
}

/* Six times the volume between an edge and the ray, of opposite sign for the two triangles at the edge, to the last
 * bit: no ray passes between them.  sum: of the edge's ends, seen from the origin. */
static inline float side_of(real3 edge, real3 sum, real3 d)
{
    return dot3(cross3(edge, sum), d);
}

static void meet_triangle(ray_block *b, const linear_triangle *given, uint32_t index)
{
    const linear_triangle tri = *given;
    EACH_LANE(i)
    {
        const real3 o = make3(b->ox[i], b->oy[i], b->oz[i]), d = make3(b->dx[i], b->dy[i], b->dz[i]);
        const real3 p0 = sub3(tri.corners[0], o), p1 = sub3(tri.corners[1], o), p2 = sub3(tri.corners[2], o);
        const float u = side_of(tri.edges[0], add3(p2, p0), d), v = side_of(tri.edges[1], add3(p0, p1), d),
                    w = side_of(tri.edges[2], add3(p1, p2), d);
        const float inverse = 1/dot3(tri.normal, d), t = dot3(tri.normal, p0)*inverse;
        const int is_inside = ((u >= 0) & (v >= 0) & (w >= 0)) | ((u <= 0) & (v <= 0) & (w <= 0));
        const float sum = (u + v) + w;
        const int is_met = is_inside & (sum != 0) & (t > b->t_min[i]) & (t < b->t[i]);
        b->t[i] = is_met ? t : b->t[i];
        b->u[i] = is_met ? u/sum : b->u[i];
        b->v[i] = is_met ? v/sum : b->v[i];
        b->which[i] = is_met ? index : b->which[i];
    }
}

/* The roots of |f + t d| = r from the foot of the perpendicular, which does not cancel; Haines, Gunther and
 * Akenine-Moller, Precision improvements for ray/sphere intersection, Ray Tracing Gems, 2019. */
static void meet_sphere(ray_block *b, const linear_sphere *given, uint32_t index)
{
    const linear_sphere s = *given;
    EACH_LANE(i)
    {
        const real3 o = make3(b->ox[i], b->oy[i], b->oz[i]), d = make3(b->dx[i], b->dy[i], b->dz[i]);
        const real3 f = sub3(o, s.center);
        const float a = dot3(d, d), towards = -dot3(f, d);
        const real3 foot = madd3(f, towards/a, d);
        const float rest = s.radius*s.radius - dot3(foot, foot);
        const float root = ksqrt(a*kmax(rest, 0));
        const float q = towards + (towards > 0 ? root : -root);
        const float c = (dot3(f, f) - s.radius*s.radius)/q, e = q/a;
        const float near = kmin(c, e), far = kmax(c, e);
        const float t = near > b->t_min[i] ? near : far;
        const int is_met = (rest > 0) & (t > b->t_min[i]) & (t < b->t[i]);
        b->t[i] = is_met ? t : b->t[i];
        b->which[i] = is_met ? index : b->which[i];
    }
}

static void meet_all(ray_block *b, const linear_scene *s)
{
    for (uint32_t i = 0; i < s->n_triangles; i++) meet_triangle(b, &s->triangles[i], i);
    for (uint32_t i = 0; i < s->n_spheres; i++) meet_sphere(b, &s->spheres[i], s->n_triangles + i);
}

static void nearest(const linear_scene *s, size_t n, rays r, hits h)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        ray_block b;
        load_rays(&b, r, first);
        meet_all(&b, s);
        const size_t some = n - first < BLOCK ? n - first : BLOCK;
        for (size_t i = 0; i < some; i++) {
            const uint32_t which = b.which[i];
            const size_t k = first + i;
            h.t[k] = b.t[i];
            h.u[k] = b.u[i];
            h.v[k] = b.v[i];
            const bool is_triangle = which < s->n_triangles;
            h.instance[k] = is_triangle ? s->triangles[which].instance : which == NO_HIT ? NO_HIT : s->sphere_instance;
            h.primitive[k] = is_triangle ? s->triangles[which].primitive : which - s->n_triangles;
        }
    }
}

static void blocked(const linear_scene *s, size_t n, rays r, uint32_t *is_blocked)
{
    for (size_t first = 0; first < n; first += BLOCK) {
        ray_block b;
        load_rays(&b, r, first);
        EACH_LANE(i) is_blocked[first + i] = b.t[i] < b.t_min[i];
        meet_all(&b, s);
        EACH_LANE(i) is_blocked[first + i] |= b.which[i] != NO_HIT;
    }
}

/* ---- Samples ------------------------------------------------------------------------------------------------- */

static void points(const sampler *given, size_t n, const uint32_t *pixel, const uint32_t *index, uint32_t group,
                   uint32_t *const u[3])
{
    const sampler s = *given;
    for (size_t first = 0; first < n; first += BLOCK) {
        uint32_t seed[BLOCK], place[BLOCK];
        EACH_LANE(i) seed[i] = seed_for(pixel[first + i], group);
        if (s.kind == SAMPLER_RANDOM) {
            for (uint32_t k = 0; k < 3; k++)
                if (u[k]) EACH_LANE(i) u[k][first + i] = random_fraction(index[first + i], seed[i], k);
            continue;
        }
        EACH_LANE(i) place[i] = shuffled_index(index[first + i], seed[i], s.index_mask);
        if (u[0]) EACH_LANE(i) u[0][first + i] = scrambled_fraction(place[i], seed[i], 0);
        if (u[1]) EACH_LANE(i) u[1][first + i] = scrambled_fraction(sobol_second(place[i]), seed[i], 1);
        if (u[2]) EACH_LANE(i) u[2][first + i] = scrambled_fraction(sobol_third(place[i]), seed[i], 2);
    }
}

/* ---- The table ----------------------------------------------------------------------------------------------- */

#include "render/light_loops_text.h"
#include "render/stage_loops_text.h"

#include "render/gradient_loops_text.h"
#include "render/surface_loops_text.h"

const render_loops RENDER_LOOPS = {.name = RENDER_LOOPS_NAME,
                                   .nearest = nearest,
                                   .blocked = blocked,
                                   .points = points,
                                   .view = view,
                                   .pack = pack,
                                   .unpack = unpack,
                                   .find_sky = find_sky,
                                   .meet = meet,
                                   .choose_light = choose_light,
                                   .rate_light = rate_light,
                                   .walk_light_tree = walk_light_tree,
                                   .rate_light_tree = rate_light_tree,
                                   .light = light,
                                   .light_any = light_any,
                                   .look_aside = look_aside,
                                   .look_at_mirror = look_at_mirror,
                                   .receive = receive,
                                   .aim = aim,
                                   .connect = connect,
                                   .scatter = scatter,
                                   .drop_dark = drop_dark,
                                   .look_back = look_back,
                                   .contrast = contrast,
                                   .reach = reach,
                                   .rate_seconds = rate_seconds,
                                   .take_lamps = take_lamps,
                                   .rate_lamps = rate_lamps,
                                   .give = give,
                                   .liken = liken,
                                   .fit = fit,
                                   .gather = gather};
