/* kernel_access.h: the kernels' functions that the public interface hides, in both precisions.
 *
 * Everything is passed as double; the single-precision table rounds its inputs once.
 * SPDX-License-Identifier: MIT */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

typedef enum kernel_distribution {
    KERNEL_COSINE, /* the Lambertian lobe; no shape */
    KERNEL_PHONG,  /* shape_x = exponent; isotropic */
    KERNEL_BECKMANN,
    KERNEL_GGX
} kernel_distribution;

/* What is known of G1 of gtr: from the polynomials that materials use, as the probability with which the sampler
 * chooses its body, by quadrature for each element, and as published. */
typedef enum kernel_masking { KERNEL_PREPARED, KERNEL_DRAWN, KERNEL_DIRECT, KERNEL_PUBLISHED } kernel_masking;

typedef struct kernel_access {
    const char *name;
    double epsilon;
    /* D(m) [1/sr]; m: unit. */
    double (*D)(kernel_distribution which, double shape_x, double shape_y, const double m[3]);
    /* A normal (a direction for the cosine lobe) of the whole distribution. */
    void (*sample_ndf)(kernel_distribution which, double shape_x, double shape_y, double ux, double uy, double m[3]);
    /* Student's distribution of slopes with n + 2 degrees of freedom: P(|slope| > q) and Lambda(q), q > 0. */
    double (*slope_tail)(double exponent, double q);
    double (*slope_Lambda)(double exponent, double q);
    /* Phong's slope towards a viewer of cotangent mu, and across over sqrt(1 + slope^2); Beckmann's for alpha = 1. */
    double (*phong_slope_along)(double exponent, double mu, double u);
    double (*phong_slope_across)(double exponent, double u);
    double (*beckmann_slope_along)(double mu, double u);
    /* Masking and shadowing together, height-correlated. */
    double (*ggx_G2)(double alpha_x, double alpha_y, const double wi[3], const double wo[3]);
    /* D(m) of gtr, stretched or as Disney writes it. */
    double (*gtr_D)(double alpha_x, double alpha_y, double gamma, int is_disney, const double m[3]);
    double (*gtr_G1)(kernel_masking which, double alpha, double gamma, double mu);
    double (*gtr_Lambda)(double alpha, double gamma, double mu);
    void (*gtr_sample_ndf)(double alpha, double gamma, double ux, double uy, double m[3]);
    /* The line q beyond which a tail of the visible normals lies, that u draws for a viewer of cotangent mu. */
    double (*gtr_tail_line)(double alpha, double gamma, double mu, double u);
    double (*fresnel_dielectric)(double c, double eta);
    /* Schlick's approximation with the dielectric's reflectance at normal incidence. */
    double (*fresnel_schlick)(double c, double eta);
    double (*fresnel_conductor)(double c, double eta, double k);
    /* F82 with the reflectance `F0` and the tint `tint`. */
    double (*fresnel_f82)(double c, double F0, double tint);
    /* 2 Int F(c) c dc */
    double (*schlick_average)(double F0, double F90);
    double (*dielectric_average)(double eta);
    double (*conductor_average)(double eta, double k);
    double (*f82_average)(double F0, double tint);
} kernel_access;

extern const kernel_access kernel_access_f32, kernel_access_f64;

#ifdef __cplusplus
}
#endif
