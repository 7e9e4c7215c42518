// Stands in for GMP's C++ interface, as far as sim/ uses it: integers are Boost.Multiprecision's.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <concepts>
#include <string>

using mp_bitcnt_t = unsigned long;

class mpz_class {
 public:
  using Number = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;
  mpz_class() = default;
  mpz_class(std::integral auto value) : value_(value) {}
  explicit mpz_class(double value) : value_(value) {}
  explicit mpz_class(Number value) : value_(std::move(value)) {}
  explicit mpz_class(const std::string& digits, int = 10) {
    bool is_negative = false;
    for (const char c : digits) {
      if (c == '-')
        is_negative = true;
      else
        value_ = value_ * 10 + (c - '0');
    }
    if (is_negative) value_ = -value_;
  }

  [[nodiscard]] const Number& number() const { return value_; }
  [[nodiscard]] mpz_class* get_mpz_t() { return this; }
  [[nodiscard]] const mpz_class* get_mpz_t() const { return this; }
  [[nodiscard]] unsigned long get_ui() const { return static_cast<unsigned long>(value_); }
  [[nodiscard]] std::size_t bits() const { return value_ == 0 ? 1 : msb(Number(abs(value_))) + 1; }
  /// Towards zero, as GMP.
  [[nodiscard]] double get_d() const {
    const auto more = static_cast<int>(bits()) - 53;
    if (more <= 0) return static_cast<double>(value_);
    const Number top = Number(abs(value_)) >> more;
    return std::ldexp(static_cast<double>(value_ < 0 ? Number(-top) : top), more);
  }

  friend mpz_class operator-(const mpz_class& a) { return mpz_class(Number(-a.value_)); }
  friend mpz_class operator+(const mpz_class& a, const mpz_class& b) { return mpz_class(Number(a.value_ + b.value_)); }
  friend mpz_class operator-(const mpz_class& a, const mpz_class& b) { return mpz_class(Number(a.value_ - b.value_)); }
  friend mpz_class operator*(const mpz_class& a, const mpz_class& b) { return mpz_class(Number(a.value_ * b.value_)); }
  friend mpz_class operator/(const mpz_class& a, const mpz_class& b) { return mpz_class(Number(a.value_ / b.value_)); }
  friend mpz_class operator<<(const mpz_class& a, mp_bitcnt_t n) { return mpz_class(Number(a.value_ << n)); }
  /// Rounds down.
  friend mpz_class operator>>(const mpz_class& a, mp_bitcnt_t n) { return mpz_class(Number(a.value_ >> n)); }
  mpz_class& operator<<=(mp_bitcnt_t n) { return *this = *this << n; }
  mpz_class& operator+=(const mpz_class& b) { return *this = *this + b; }
  mpz_class& operator-=(const mpz_class& b) { return *this = *this - b; }
  mpz_class& operator*=(const mpz_class& b) { return *this = *this * b; }
  mpz_class& operator/=(const mpz_class& b) { return *this = *this / b; }
  friend bool operator==(const mpz_class& a, const mpz_class& b) { return a.value_ == b.value_; }
  friend bool operator<(const mpz_class& a, const mpz_class& b) { return a.value_ < b.value_; }
  friend bool operator>(const mpz_class& a, const mpz_class& b) { return b < a; }
  friend bool operator<=(const mpz_class& a, const mpz_class& b) { return !(b < a); }
  friend bool operator>=(const mpz_class& a, const mpz_class& b) { return !(a < b); }
  friend mpz_class abs(const mpz_class& a) { return a < 0 ? -a : a; }
  friend int sgn(const mpz_class& a) { return a.value_.sign(); }

 private:
  Number value_;
};

inline std::size_t mpz_sizeinbase(const mpz_class* a, int) { return a->bits(); }
inline void mpz_pow_ui(mpz_class* result, const mpz_class* base, unsigned long exponent) {
  *result = mpz_class(mpz_class::Number(pow(base->number(), static_cast<unsigned>(exponent))));
}
inline void mpz_fdiv_q(mpz_class* result, const mpz_class* a, const mpz_class* b) {
  mpz_class quotient = *a / *b;
  const mpz_class rest = *a - quotient * *b;
  if (rest != 0 && (rest < 0) != (*b < 0)) quotient -= 1;
  *result = quotient;
}

/// Always in lowest terms, the denominator positive.
class mpq_class {
 public:
  mpq_class() : den_(1) {}
  mpq_class(std::integral auto value) : num_(value), den_(1) {}
  mpq_class(const mpz_class& value) : num_(value), den_(1) {}
  mpq_class(const mpz_class& num, const mpz_class& den) : num_(num), den_(den) { canonicalize(); }
  mpq_class(double value) : den_(1) {
    int exponent = 0;
    num_ = mpz_class(std::ldexp(std::frexp(value, &exponent), 53));
    exponent -= 53;
    (exponent < 0 ? den_ : num_) <<= static_cast<mp_bitcnt_t>(std::abs(exponent));
    canonicalize();
  }

  void canonicalize() {
    const mpz_class common(mpz_class::Number(gcd(num_.number(), den_.number())));
    if (common != 1) num_ /= common, den_ /= common;
    if (den_ < 0) num_ = -num_, den_ = -den_;
  }
  [[nodiscard]] mpz_class& get_num() { return num_; }
  [[nodiscard]] mpz_class& get_den() { return den_; }
  [[nodiscard]] const mpz_class& get_num() const { return num_; }
  [[nodiscard]] const mpz_class& get_den() const { return den_; }
  [[nodiscard]] const mpz_class* get_num_mpz_t() const { return &num_; }
  [[nodiscard]] const mpz_class* get_den_mpz_t() const { return &den_; }
  /// Towards zero, as GMP.
  [[nodiscard]] double get_d() const {
    if (num_ == 0) return 0;
    const mpz_class size = abs(num_);
    const int shift =
        54 - static_cast<int>(size.bits()) + static_cast<int>(den_.bits());  // a quotient of 54 or 55 bits
    const mpz_class quotient = shift >= 0 ? (size << static_cast<mp_bitcnt_t>(shift)) / den_
                                          : size / (den_ << static_cast<mp_bitcnt_t>(-shift));
    const double found = std::ldexp(quotient.get_d(), -shift);
    return num_ < 0 ? -found : found;
  }

  friend mpq_class operator-(const mpq_class& a) { return {-a.num_, a.den_}; }
  friend mpq_class operator+(const mpq_class& a, const mpq_class& b) {
    return {a.num_ * b.den_ + b.num_ * a.den_, a.den_ * b.den_};
  }
  friend mpq_class operator-(const mpq_class& a, const mpq_class& b) { return a + -b; }
  friend mpq_class operator*(const mpq_class& a, const mpq_class& b) { return {a.num_ * b.num_, a.den_ * b.den_}; }
  friend mpq_class operator/(const mpq_class& a, const mpq_class& b) { return {a.num_ * b.den_, a.den_ * b.num_}; }
  mpq_class& operator+=(const mpq_class& b) { return *this = *this + b; }
  mpq_class& operator-=(const mpq_class& b) { return *this = *this - b; }
  mpq_class& operator*=(const mpq_class& b) { return *this = *this * b; }
  mpq_class& operator/=(const mpq_class& b) { return *this = *this / b; }
  friend bool operator==(const mpq_class& a, const mpq_class& b) { return a.num_ == b.num_ && a.den_ == b.den_; }
  friend bool operator<(const mpq_class& a, const mpq_class& b) { return a.num_ * b.den_ < b.num_ * a.den_; }
  friend bool operator>(const mpq_class& a, const mpq_class& b) { return b < a; }
  friend bool operator<=(const mpq_class& a, const mpq_class& b) { return !(b < a); }
  friend bool operator>=(const mpq_class& a, const mpq_class& b) { return !(a < b); }
  friend mpq_class abs(const mpq_class& a) { return a.num_ < 0 ? -a : a; }
  friend int cmp(const mpq_class& a, const mpq_class& b) { return a < b ? -1 : b < a ? 1 : 0; }
  friend int sgn(const mpq_class& a) { return sgn(a.num_); }

 private:
  mpz_class num_, den_;
};

inline double mpq_get_d(const mpq_class* a) { return a->get_d(); }
