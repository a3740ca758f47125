/* table_glsl.ts: the sampler of brdf/table_sampler.ts for shaders: its tables are a texture of as many layers.
 *
 * SPDX-License-Identifier: MIT */
import type { Brdf } from "../brdf/brdf";
import { EVEN, LAST_THETA, RINGS, SECTORS, tableSampler, type TableSampler } from "../brdf/table_sampler";

export const TABLE_SAMPLER = `
uniform highp sampler2DArray directions_table;
uniform vec2 directions_size; // angles, azimuths
const float TABLE_RINGS = ${RINGS}.0, TABLE_SECTORS = ${SECTORS}.0, TABLE_EVEN = ${EVEN};
const float TABLE_LAST_THETA = ${LAST_THETA}.0*3.14159265/180.0;
float table_versine(float ring)
{
    float x = ring/TABLE_RINGS, s = sin(1.57079633*x*x*x);
    return 2.0*s*s;
}
// Away from the normal, around it, and the mirror's direction.
mat3 table_frame(vec3 wo)
{
    float s = length(wo.xy);
    vec2 m = s > 1e-6 ? -wo.xy/s : vec2(1, 0);
    return mat3(vec3(m*wo.z, -s), vec3(-m.y, m.x, 0), vec3(m*s, wo.z));
}
int table_layer(vec3 wo, out float part)
{
    float s = length(wo.xy), last = directions_size.x - 1.0;
    float at = min(last, atan(s, wo.z)*(last/TABLE_LAST_THETA)), k = min(floor(at), last - 1.0);
    float turn = s > 1e-6 ? atan(-wo.y, -wo.x)/6.28318531 : 0.0;
    float j = mod(floor(fract(turn)*directions_size.y + 0.5), directions_size.y);
    part = at - k;
    return int(j*directions_size.x + k);
}
float shade_pdf(vec3 wi, vec3 wo)
{
    if (wi.z <= 0.0) return 0.0;
    float part;
    int layer = table_layer(wo, part);
    mat3 frame = table_frame(wo);
    vec3 v = wi*frame, away = wi - frame[2];
    float angle = 2.0*asin(min(1.0, 0.5*length(away)));
    float turn = abs(v.x) + abs(v.y) > 0.0 ? atan(v.y, v.x)/6.28318531 : 0.0;
    ivec2 cell = ivec2(TABLE_SECTORS*fract(turn), TABLE_RINGS*pow(max(angle, 1e-20)/3.14159265, 1.0/3.0));
    cell = min(cell, ivec2(${SECTORS - 1}, ${RINGS - 1}));
    float p = mix(texelFetch(directions_table, ivec3(cell, layer), 0).y,
                  texelFetch(directions_table, ivec3(cell, layer + 1), 0).y, part);
    return TABLE_EVEN*wi.z/3.14159265 + (1.0 - TABLE_EVEN)*p;
}
// The first entry of a row that is above u, and where u is between the one before and it.
int table_search(int row, int layer, float u, out float rest)
{
    int at = 0;
    for (int leap = ${SECTORS / 2}; leap > 0; leap >>= 1)
        if (texelFetch(directions_table, ivec3(at + leap - 1, row, layer), 0).x <= u) at += leap;
    float below = at > 0 ? texelFetch(directions_table, ivec3(at - 1, row, layer), 0).x : 0.0;
    float width = texelFetch(directions_table, ivec3(at, row, layer), 0).x - below;
    rest = width > 0.0 ? clamp((u - below)/width, 0.0, 1.0) : 0.5;
    return at;
}
vec3 shade_sample(vec3 wo, vec3 u, out vec3 wi, out float pdf)
{
    if (u.z < TABLE_EVEN) {
        float s = sqrt(u.x), phi = 6.28318531*u.y;
        wi = vec3(s*cos(phi), s*sin(phi), sqrt(max(1.0 - u.x, 0.0)));
    } else {
        float part, in_ring, in_sector;
        int layer = table_layer(wo, part);
        if ((u.z - TABLE_EVEN)/(1.0 - TABLE_EVEN) < part) layer++;
        int ring = table_search(${RINGS}, layer, u.x, in_ring);
        int sector = table_search(ring, layer, u.y, in_sector);
        float v = mix(table_versine(float(ring)), table_versine(float(ring + 1)), in_ring);
        float turn = 6.28318531*(float(sector) + in_sector)/TABLE_SECTORS, s = sqrt(max(v*(2.0 - v), 0.0));
        wi = table_frame(wo)*vec3(s*cos(turn), s*sin(turn), 1.0 - v);
    }
    pdf = shade_pdf(wi, wo);
    return wi.z > 1e-4 ? shade_eval(wi, wo)/pdf : vec3(0);
}
`;

const MOST_KEPT = 8,
  UNIT = 6;
const textures = new WeakMap<WebGL2RenderingContext, Map<TableSampler, WebGLTexture>>();

function textureOf(gl: WebGL2RenderingContext, sampler: TableSampler): WebGLTexture {
  let kept = textures.get(gl);
  if (!kept) textures.set(gl, (kept = new Map()));
  let texture = kept.get(sampler);
  if (texture) return texture;
  const { texels, nThetas, nAzimuths } = sampler.tables;
  kept.set(sampler, (texture = gl.createTexture()!));
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RG32F, SECTORS, RINGS + 1, nThetas * nAzimuths);
  gl.texSubImage3D(
    gl.TEXTURE_2D_ARRAY,
    ...([0, 0, 0, 0, SECTORS, RINGS + 1, nThetas * nAzimuths] as const),
    ...([gl.RG, gl.FLOAT, texels] as const),
  );
  gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  if (kept.size > MOST_KEPT) {
    const [[oldest, unused]] = kept;
    gl.deleteTexture(unused);
    kept.delete(oldest);
  }
  return texture;
}

/** Makes the tables where the program in use samples: spheres and numbers need none. */
export function bindTable(gl: WebGL2RenderingContext, program: WebGLProgram, brdf: Brdf): void {
  const place = gl.getUniformLocation(program, "directions_table");
  if (!place) return;
  const sampler = tableSampler(brdf);
  gl.activeTexture(gl.TEXTURE0 + UNIT);
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, textureOf(gl, sampler));
  gl.uniform1i(place, UNIT);
  gl.uniform2f(gl.getUniformLocation(program, "directions_size"), sampler.tables.nThetas, sampler.tables.nAzimuths);
  gl.activeTexture(gl.TEXTURE0);
}
