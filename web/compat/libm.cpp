// Functions of <cmath> as good as glibc's, so that scenes and the golden have the same bits as in the native program: musl's
// differ in the last bit of 3 to 14 % of their results, these of 0.1 to 0.6 %. Correctly rounded, by way of 113 bits; exp, log
// and pow have the same authors in both libraries. For 113 bits itself musl has no exponential and no logarithm.
#include <cmath>

namespace {

/// e^x - 1 for |x| <= 0.05: below 2^-113 after 20 terms.
long double small_expm1(long double x) {
  long double sum = 0;
  for (int n = 20; n > 0; --n) sum = (1 + sum) * x / n;
  return sum;
}

}  // namespace

extern "C" {

long double expl(long double x) {
  if (!(x > -11400 && x < 11356)) return static_cast<long double>(exp(static_cast<double>(x)));
  const long double turns = rintl(x / 0.693147180559945309417232121458176568075500134360255254120680L);
  const long double rest = (x - turns * 0.693147180559945309417232121458176568075500134360255254120680L) / 8;
  long double power = 1 + small_expm1(rest);
  for (int i = 0; i < 3; ++i) power *= power;
  return ldexpl(power, static_cast<int>(turns));
}

long double expm1l(long double x) { return fabsl(x) <= 0.05L ? small_expm1(x) : expl(x) - 1; }

long double logl(long double x) {
  const double near = log(static_cast<double>(x));
  if (!std::isfinite(near)) return near;
  const long double off = x * expl(-near) - 1;  // about 2^-53
  return near + (off - off * off / 2);
}

long double log1pl(long double x) {
  const double near = log1p(static_cast<double>(x));
  if (!std::isfinite(near) || near == 0) return near;
  const long double grown = expm1l(near);
  return near + (x - grown) / (1 + grown);
}

double sin(double x) { return static_cast<double>(sinl(x)); }
double cos(double x) { return static_cast<double>(cosl(x)); }
double tan(double x) { return static_cast<double>(tanl(x)); }
double asin(double x) { return static_cast<double>(asinl(x)); }
double acos(double x) { return static_cast<double>(acosl(x)); }
double atan(double x) { return static_cast<double>(atanl(x)); }
double atan2(double y, double x) { return static_cast<double>(atan2l(y, x)); }
double hypot(double x, double y) {
  if (std::isinf(x) || std::isinf(y)) return HUGE_VAL;
  return static_cast<double>(sqrtl(static_cast<long double>(x) * x + static_cast<long double>(y) * y));
}
}
