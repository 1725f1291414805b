#pragma once

namespace stipple::poisson_table {

// The quantile of a Poisson variable with mean m at the normal quantile w is floor(x), where x
// solves Q(x, m) = Phi(w) and the regularised incomplete gamma function Q continues P(X < x) to
// real x. Temme's uniform expansion, with s = w / sqrt(m) and f(r) = sign(r - 1) sqrt(2 (1 - r + r
// log r)), reads
//
//     x = m + sqrt(m) w + w^2 g(s) + c0(s) + c1(s) / m + c2(s) / m^2,
//     g(s) = (f^-1(s) - 1 - s) / s^2,   c0(s) = log(f(r) sqrt(r) / (r - 1)) / log r, r = f^-1(s).
//
// g and c0 are polynomials fitted at 400 Chebyshev nodes to extended-precision values. c1 and c2
// are least-squares fits of the remainder to the exact x (inverted incomplete gamma), reweighted
// to minimise the max error in probability. All coefficients start with the
// lowest power and are rounded to float. Source of the expansion: Giles, Algorithm 955, ACM TOMS 42
// (2016).

inline constexpr float kSumBelow = 4;       ///< smaller means are summed term by term
inline constexpr float kRecheckBelow = 32;  ///< smaller means: doubtful quantiles are summed
inline constexpr float kShortFrom = 100;    ///< means from here on use the short fit
inline constexpr float kMinS = -1.27F;      ///< interval of s of the full fit
inline constexpr float kMaxS = 2.05F;
inline constexpr float kDoubtfulW = 4;        ///< |w| beyond which the fit is not trusted
inline constexpr float kDoubtfulX = 0.0012F;  ///< distance of x to an integer, likewise

// Full fit: 4 <= mean, kMinS <= s <= kMaxS; c1, c2 fitted at means 4 to 60.
/// g(s)
inline constexpr float kG[] = {
    0.166666716F,     -0.0138862357F,   0.0037007893F,    -0.00136692869F,  0.000591619231F,
    -0.000126049854F, -4.83390295e-06F, -0.000250020064F, 0.000263265945F,  6.22251828e-05F,
    -0.000163504694F, 1.86618636e-05F,  5.13222294e-05F,  -2.54211791e-05F, 3.65516576e-06F};
/// c0(s)
inline constexpr float kC0[] = {0.333328187F,    -0.0278297048F,  0.008824802F,    -0.00305554201F,
                                0.000551873236F, -0.0018152229F,  0.0028546399F,   7.23929334e-05F,
                                -0.00199398398F, 0.000496459194F, 0.000692880654F, -0.000426409621F,
                                6.98906006e-05F};
/// c1(s)
inline constexpr float kC1[] = {-0.0192353893F, 0.0222583394F, -0.0217834469F,
                                -0.0124450456F, 0.0152983284F, 0.0169496611F,
                                -0.0198788512F, 0.0102031156F, -0.00278143189F};
/// c2(s)
inline constexpr float kC2[] = {-0.00190120726F, -0.0231912192F, 0.0259348527F, 0.11405044F,
                                -0.0612805746F,  -0.0996261612F, 0.052961655F};

// Short fit: mean >= 64, |s| <= 0.8; c1 fitted at means 64 to 200.
/// g(s)
inline constexpr float kShortG[] = {0.166666672F,    -0.0138886822F,   0.00370335579F,
                                    -0.00133516605F, 0.000562678208F,  -0.00023603029F,
                                    0.00011020957F,  -0.000106902029F, 6.24574022e-05F};
/// c0(s)
inline constexpr float kShortC0[] = {0.333339065F, -0.0276297852F, 0.00848830398F, -0.00438060891F,
                                     0.00223839143F};
/// c1(s)
inline constexpr float kShortC1[] = {-0.0203902405F, 0.00890321843F};

}  // namespace stipple::poisson_table
