/* primitives.glsl: the functions of core/kernel that GLSL writes in another way; each takes the place of the C function
 * of its name.  Rounding stands here because a shader compiler may reassociate (x + c) - c.
 * SPDX-License-Identifier: MIT */

float ksqrt(float x) { return sqrt(x); }

uint bits_of(float x) { return floatBitsToUint(x); }
float real_of(uint b) { return uintBitsToFloat(b); }

float kround(float x) { return roundEven(x); }

real_integer round_to_integer(float x)
{
    real_integer r;
    r.n   = roundEven(x);
    r.low = uint(int(r.n));
    return r;
}
