/* stage_loops_text.h: the loops over vertices, a part of loops_text.h.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

static inline real3 lane3(const vector_array *a, size_t k)
{
    return make3(a->x[k], a->y[k], a->z[k]);
}

static inline void put_lane3(vector_array *a, size_t k, real3 v)
{
    a->x[k] = v.x;
    a->y[k] = v.y;
    a->z[k] = v.z;
}

/* Those of the pixels themselves. */
static inline vectors frame_of(framed_array *a)
{
    const vectors v = {a->x + MARGIN, a->y + MARGIN, a->z + MARGIN};
    return v;
}

static void view(const camera *given, float extent, float width, float height, size_t n, const float *x, const float *y,
                 uint32_t *const u[3], ray_array *r)
{
    const camera c = *given;
    const float of_place = c.is_orthographic ? 1 : 0, of_direction = 1 - of_place; /* what the pixel moves */
    for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float px = x[k] + fraction(u[0][k]), py = y[k] + fraction(u[1][k]);
            const float right = (2*px/width - 1)*width/height*extent, up = (1 - 2*py/height)*extent;
            const real3 place = make3(of_place*right, of_place*up, 0),
                        ahead = make3(of_direction*right, of_direction*up, -1);
            put_lane3(&r->origin, k, map_point(c.to_world, place));
            put_lane3(&r->direction, k, normalize3(map_vector(c.to_world, ahead)));
            r->t_min[k] = 0;
            r->t_max[k] = INFINITY;
            r->seed[k] = u[2][k];
        }
}

/* to_local and to_world in the vertex's frame; gcc would keep a record of it in memory. */
static inline real3 lane_to_local(const vertex_list *v, size_t k, real3 d)
{
    return make3(dot3(d, lane3(&v->t, k)), dot3(d, lane3(&v->b, k)), dot3(d, lane3(&v->up, k)));
}

static inline real3 lane_to_world(const vertex_list *v, size_t k, real3 d)
{
    return add3(add3(scale3(d.x, lane3(&v->t, k)), scale3(d.y, lane3(&v->b, k))), scale3(d.z, lane3(&v->up, k)));
}

/* Positive where wi and wo lie on the same side of the true surface for a reflection, and on opposite ones for light
 * that goes through; interpolated normals can claim otherwise.  through: the sign bit for the latter, else 0. */
static inline float true_side(const vertex_list *v, size_t k, real3 wi, uint32_t through)
{
    return real_of(bits_of(dot3(lane3(&v->normal, k), wi)*v->facing[k]) ^ through);
}

/* Across the plane of wo and the normal, at 60 degrees from the latter: far from the mirror image, whatever wo. */
static void look_aside(vertex_list *v)
{
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const float x = v->wo.x[k], y = v->wo.y[k], r2 = x*x + y*y;
            const float sin = 0.8660254f/ksqrt(kmax(r2, REAL_MIN));
            const int is_upright = r2 < 1e-12f;
            v->wi.x[k] = is_upright ? 0.8660254f : -y*sin;
            v->wi.y[k] = is_upright ? 0 : x*sin;
            v->wi.z[k] = 0.5f;
        }
}

static void look_at_mirror(vertex_list *v)
{
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            v->receiver.broad[k] = kmin(2*kmax(v->pdf[k], 0), INV_PI);
            v->wi.x[k] = -v->wo.x[k];
            v->wi.y[k] = -v->wo.y[k];
            v->wi.z[k] = v->wo.z[k];
        }
}

static void receive(vertex_list *v)
{
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 mirror = lane_to_world(v, k, lane3(&v->wi, k));
            const float cos = v->wo.z[k], broad = v->receiver.broad[k];
            const int is_opaque = (v->transmits[k] == 0) & (cos > 0);
            const float rest = kmax(v->pdf[k] - broad*cos, 0);
            /* The lobe holds what is not broad: its integral is 4 pi width peak. */
            const float width = kmax(1 - PI*broad, 0.01f)/(FOUR_PI*kmax(cos, 0.1f)*kmax(rest, 1e-3f));
            v->receiver.normal.x[k] = keep_if(is_opaque, v->up.x[k]);
            v->receiver.normal.y[k] = keep_if(is_opaque, v->up.y[k]);
            v->receiver.normal.z[k] = keep_if(is_opaque, v->up.z[k]);
            v->receiver.mirror.x[k] = keep_if(is_opaque, mirror.x);
            v->receiver.mirror.y[k] = keep_if(is_opaque, mirror.y);
            v->receiver.mirror.z[k] = keep_if(is_opaque, mirror.z);
            v->receiver.around[k] = is_opaque ? RECEIVED_AROUND : 1;
            v->receiver.broad[k] = keep_if(is_opaque, broad);
            v->receiver.peak[k] = keep_if(is_opaque, kmin(rest, 1e7f));
            v->receiver.width[k] = kmin(kmax(width, 1e-8f), 1);
            v->receiver.weight[k] = 0;
        }
}

static void aim(vertex_list *v, bool is_implicit)
{
    const uint32_t is_any = !is_implicit;
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 direction = lane3(&v->light.direction, k), wi = lane_to_local(v, k, direction);
            const uint32_t through = (bits_of(wi.z) ^ bits_of(v->wo.z[k])) & SIGN_BIT & v->transmits[k];
            const float pdf = keep_if((v->light.is_delta[k] | is_any) != 0, v->light.pdf[k]);
            v->light.pdf[k] = keep_if(true_side(v, k, direction, through) > 0, pdf);
            put_lane3(&v->wi, k, wi);
        }
}

static void find_sky(size_t n, vectors direction, float *u, float *v)
{
    for (size_t first = 0; first < n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real2 place = sky_place(make3(direction.x[k], direction.y[k], direction.z[k]));
            u[k] = place.x;
            v[k] = place.y;
        }
}

/* Where a ray starts, just off the surface. */
static inline real3 start_of(const vertex_list *v, size_t k, real3 direction)
{
    return leave_surface(lane3(&v->position, k), lane3(&v->normal, k), v->offset[k], direction);
}

static void connect(vertex_list *v, bool is_mis, sight_list *to)
{
    const vectors origins = frame_of(&to->origin), directions = frame_of(&to->direction);
    float *t_max = to->t_max + MARGIN;
    uint32_t *seed = to->seed + MARGIN, *is_open = to->is_open + MARGIN;
    const uint32_t is_alone = !is_mis;
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 f = lane3(&v->f, k), direction = lane3(&v->light.direction, k);
            const float pdf = v->light.pdf[k];
            const int has_rival = (v->light.is_delta[k] | is_alone) == 0;
            const float weight = power_heuristic(pdf, keep_if(has_rival, v->pdf[k]));
            const int is_infinite = v->light.is_infinite[k] != 0;
            const int keeps = (pdf > 0) & (max_of3(f) > 0);
            const real3 light = mul3(f, scale3(weight/pdf, lane3(&v->light.radiance, k)));
            const real3 brings = mul3(lane3(&v->throughput, k), light);
            is_open[k] = keeps;
            put_lane3(&v->f, k, make3(keep_if(keeps, brings.x), keep_if(keeps, brings.y), keep_if(keeps, brings.z)));
            const real3 origin = start_of(v, k, direction);
            origins.x[k] = origin.x;
            origins.y[k] = origin.y;
            origins.z[k] = origin.z;
            directions.x[k] = is_infinite ? direction.x : v->light.target.x[k] - origin.x;
            directions.y[k] = is_infinite ? direction.y : v->light.target.y[k] - origin.y;
            directions.z[k] = is_infinite ? direction.z : v->light.target.z[k] - origin.z;
            t_max[k] = is_infinite ? INFINITY : 1;
            seed[k] = v->u[0][k] ^ v->u[1][k];
        }
}

/* What a smooth interface lets through has no other way. */
#define THROUGH_GLASS (FACET_TRANSMISSION | FACET_DELTA)

static void scatter(vertex_list *v, bool has_roulette)
{
    const float enough = has_roulette ? 1/ROULETTE_BELOW : REAL_MAX; /* else all that is not black goes on */
    for (size_t first = 0; first < v->n; first += BLOCK) EACH_LANE(i)
        {
            const size_t k = first + i;
            const real3 world = lane_to_world(v, k, lane3(&v->wi, k)), wi = scale3(1/length3(world), world);
            const uint32_t through = (v->lobe[k] & FACET_TRANSMISSION) != 0 ? SIGN_BIT : 0;
            const float side = (v->lobe[k] & THROUGH_GLASS) == THROUGH_GLASS ? 1 : true_side(v, k, wi, through);
            const real3 throughput = mul3(lane3(&v->throughput, k), lane3(&v->f, k));
            const float eta_scale = v->eta_scale[k]*v->eta[k]*v->eta[k];
            /* Russian roulette: the paths that go on carry what the others would have. */
            const float share = max_of3(throughput)*eta_scale*enough;
            v->keeps[k] = fraction(v->chance[k]) < keep_if(v->pdf[k] > 0, keep_if(side > 0, share));
            put_lane3(&v->f, k, scale3(1/kmin(share, 1), throughput));
            v->eta_scale[k] = eta_scale;
            put_lane3(&v->ray.origin, k, start_of(v, k, wi));
            put_lane3(&v->ray.direction, k, wi);
            v->ray.seed[k] = v->u[0][k] ^ v->u[2][k];
        }
}
