/* any_model.glsl: a fragment shader's rest, below the text of a model called MODEL (its functions by macros): what eval,
 * pdf and sample give for the directions and numbers of three textures.
 * SPDX-License-Identifier: MIT */

#ifdef VULKAN
layout(std140, binding = 0) uniform Material { uvec4 material[MODEL_WORDS]; };
layout(binding = 1) uniform sampler2D wi_map;
layout(binding = 2) uniform sampler2D wo_map;
layout(binding = 3) uniform sampler2D u_map;
#else
uniform uvec4 material[MODEL_WORDS];
uniform highp sampler2D wi_map;
uniform highp sampler2D wo_map;
uniform highp sampler2D u_map;
#endif

layout(location = 0) out vec4 value_pdf;
layout(location = 1) out vec4 wi_pdf;
layout(location = 2) out vec4 weight_eta;
layout(location = 3) out vec4 lobe;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 wi = texelFetch(wi_map, at, 0).xyz;
    vec3 wo = texelFetch(wo_map, at, 0).xyz;
    vec3 u = texelFetch(u_map, at, 0).xyz;
    MODEL_params p = MODEL_load(material);
    bsdf_sample s = MODEL_sample(p, wo, u);
    value_pdf = vec4(MODEL_eval(p, wi, wo), MODEL_pdf(p, wi, wo));
    wi_pdf = vec4(s.wi, s.pdf);
    weight_eta = vec4(s.weight, s.eta);
    lobe = vec4(float(s.lobe));
}
