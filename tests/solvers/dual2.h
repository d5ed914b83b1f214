#pragma once

#include <Eigen/Core>
#include <cmath>

namespace vmech::textbook {

/// A number with its gradient and Hessian in n variables: exact derivatives for test problems.
struct Dual2 {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;

  static Dual2 Constant(double value, Eigen::Index n) {
    return {value, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
  }
  static Dual2 Variable(double value, Eigen::Index i, Eigen::Index n) {
    return {value, Eigen::VectorXd::Unit(n, i), Eigen::MatrixXd::Zero(n, n)};
  }
  /// f(u) from f, f' and f'' at u.value.
  static Dual2 Chain(const Dual2& u, double f, double df, double ddf) {
    return {f, df * u.gradient, df * u.hessian + ddf * u.gradient * u.gradient.transpose()};
  }
};

inline Dual2 operator+(const Dual2& a, const Dual2& b) {
  return {a.value + b.value, a.gradient + b.gradient, a.hessian + b.hessian};
}
inline Dual2 operator*(const Dual2& a, const Dual2& b) {
  return {a.value * b.value, a.value * b.gradient + b.value * a.gradient,
          a.value * b.hessian + b.value * a.hessian + a.gradient * b.gradient.transpose() +
              b.gradient * a.gradient.transpose()};
}
inline Dual2 operator*(double s, const Dual2& a) {
  return {s * a.value, s * a.gradient, s * a.hessian};
}
inline Dual2 operator-(const Dual2& a) {
  return -1.0 * a;
}
inline Dual2 operator-(const Dual2& a, const Dual2& b) {
  return a + (-1.0 * b);
}
inline Dual2 operator+(const Dual2& a, double s) {
  return {a.value + s, a.gradient, a.hessian};
}
inline Dual2 operator-(const Dual2& a, double s) {
  return a + (-s);
}
inline Dual2 operator+(double s, const Dual2& a) {
  return a + s;
}
inline Dual2 operator-(double s, const Dual2& a) {
  return -1.0 * a + s;
}
inline Dual2 sin(const Dual2& a) {
  return Dual2::Chain(a, std::sin(a.value), std::cos(a.value), -std::sin(a.value));
}
inline Dual2 cos(const Dual2& a) {
  return Dual2::Chain(a, std::cos(a.value), -std::sin(a.value), -std::cos(a.value));
}

}  // namespace vmech::textbook
