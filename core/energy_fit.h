/* energy_fit.h: the directional albedo of a distribution of normals with F = 1, and the polynomial of
 * kernel/energy.h that stands for it.
 *
 * Everything is computed in double, for prepared materials of either precision.
 * SPDX-License-Identifier: MIT */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/* Which surface; the fields are those of kernel/distribution.h and the choices of kernel/microfacet.h. */
typedef struct energy_surface {
    int kind, masking, g2;
    double alpha_x, alpha_y;
    double exponent; /* phong */
    double gamma;    /* gtr */
    int anisotropy;  /* gtr */
} energy_surface;

/* The fields of `energy` that depend on the surface alone, and the average of C. */
typedef struct energy_fit {
    int is_isotropic, is_root, power;
    double reach2_x, reach2_y, reach2_z, a_n, skew;
    double loss_average;
    double coefficients[56];
} energy_fit;

/* E by quadrature at the nodes of the polynomial, within 6e-5, and the polynomial.  Takes .3 ms to 20 ms.
 * Thread safe; allocates nothing. */
void facet_energy_fit_surface(const energy_surface *surface, energy_fit *fit);

#ifdef __cplusplus
}
#endif
