#pragma once

namespace stipple::normal_table {

// Natural logarithm of a mantissa 1 + z, sqrt(1/2) <= 1 + z < sqrt(2):
// log(1 + z) = z - z^2 / 2 + z^3 P(z); the lowest power first. Source: Cephes, logf.
inline constexpr float kLog[] = {3.3333331174E-1F,  -2.4999993993E-1F, 2.0000714765E-1F,
                                 -1.6668057665E-1F, 1.4249322787E-1F,  -1.2420140846E-1F,
                                 1.1676998740E-1F,  -1.1514610310E-1F, 7.0376836292E-2F};
inline constexpr float kSqrtHalf = 0.707106781186547524F;
inline constexpr float kLn2High = 0.693359375F;  // exact products with exponents
inline constexpr float kLn2Low = -2.12194440e-4F;

// sqrt(2) erfinv(x) = x P(l - 2.5) for l = -log(1 - x^2) < 5, x Q(sqrt(l) - 3) up to the smallest
// tail of a word, 2^-33 (l < 21.5); the lowest power first. The form is that of M. Giles,
// "Approximating the erfinv function", GPU Computing Gems 2 (2011), whose coefficients end at
// 2^-24; these interpolate at the Chebyshev nodes of each interval (40 digits, rounded to float).
// Largest relative error 1.8e-7 and 2.0e-7.
inline constexpr float kTailFrom = 5;
inline constexpr float kCentre[] = {2.12331343F,      0.348802716F,    -0.00590765988F,
                                    -0.00177308277F,  0.000308741175F, -6.19474577e-06F,
                                    -4.88579599e-06F, 4.83978852e-07F, 3.19696802e-08F};
inline constexpr float kTail[] = {
    4.00643444F,     1.41658485F,    0.0133424075F,    -0.0108299376F,   0.00815359503F,
    -0.00502283592F, 0.00182082399F, -5.28688906e-05F, -0.000208008933F, 5.16923101e-05F};

}  // namespace stipple::normal_table
