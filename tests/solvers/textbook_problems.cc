#include "textbook_problems.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace vmech::textbook {
namespace {

using V = std::vector<Dual2>;

std::vector<Dual2> Variables(const VectorXd& x) {
  std::vector<Dual2> variables;
  for (int i = 0; i < x.size(); ++i) variables.push_back(Dual2::Variable(x[i], i, x.size()));
  return variables;
}

void Write(const std::vector<Dual2>& values, VectorXd* f, MatrixXd* F) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (f) (*f)[i] = values[i].value;
    if (F) F->row(i) = values[i].gradient;
  }
}

Dual2 Square(const Dual2& a) {
  return a * a;
}
Dual2 Cube(const Dual2& a) {
  return a * a * a;
}
Dual2 Fourth(const Dual2& a) {
  return Square(Square(a));
}

VectorXd Vec(std::initializer_list<double> values) {
  return Eigen::Map<const VectorXd>(values.begin(), static_cast<int>(values.size()));
}

// A problem from its formulas; the counts of r and c are found by calling them.
TextbookProblem Formula(const std::string& name, const VectorXd& start, const VectorXd& solution,
                        double objective, Functions r, Functions c, std::vector<Bound> bounds = {},
                        double tolerance = 1e-7) {
  const V probe = Variables(start);
  const int n = static_cast<int>(start.size());
  const ProblemSizes sizes{n, n, static_cast<int>(r(probe).size()),
                           static_cast<int>(c(probe).size())};
  return {name,      [=] { return std::make_unique<FormulaProblem>(sizes, r, c, bounds); },
          start,     solution,
          objective, tolerance};
}

V None(const V&) {
  return {};
}

const double kSqrt2 = std::sqrt(2.0);

// W. Hock, K. Schittkowski, Test Examples for Nonlinear Programming Codes (1981): those of its
// equality-constrained problems that are sums of squares. Their objective is |r|^2. Where the
// residuals are squares or cubes that vanish at the solution the minimum is flat, and x is known to
// a root of the KKT tolerance only.
void AddHockSchittkowski(std::vector<TextbookProblem>* all) {
  constexpr double kFlat = 0.05;
  constexpr double kPrinted = 2e-6;  // seven digits are printed
  const VectorXd ones = VectorXd::Ones(5);
  all->push_back(Formula(
      "HS6", Vec({-1.2, 1}), Vec({1, 1}), 0, [](const V& x) { return V{1 - x[0]}; },
      [](const V& x) { return V{10 * (x[1] - Square(x[0]))}; }));
  const double a = std::sqrt((25 + std::sqrt(301.0)) / 2);
  all->push_back(Formula("HS8", Vec({4, 2}), Vec({a, 9 / a}), 0, None, [](const V& x) {
    return V{Square(x[0]) + Square(x[1]) - 25, x[0] * x[1] - 9};
  }));
  all->push_back(Formula(
      "HS26", Vec({-2.6, 2, 2}), Vec({1, 1, 1}), 0,
      [](const V& x) {
        return V{x[0] - x[1], Square(x[1] - x[2])};
      },
      [](const V& x) { return V{(1 + Square(x[1])) * x[0] + Fourth(x[2]) - 3}; }, {}, kFlat));
  all->push_back(Formula(
      "HS27", Vec({2, 2, 2}), Vec({-1, 1, 0}), 0.02,
      [](const V& x) {
        return V{0.1 * (x[0] - 1), x[1] - Square(x[0])};
      },
      [](const V& x) { return V{x[0] + Square(x[2]) + 1}; }, {}, 1e-6));
  all->push_back(Formula(
      "HS28", Vec({-4, 1, 1}), Vec({0.5, -0.5, 0.5}), 0,
      [](const V& x) {
        return V{x[0] + x[1], x[1] + x[2]};
      },
      [](const V& x) { return V{x[0] + 2 * x[1] + 3 * x[2] - 1}; }));
  all->push_back(Formula(
      "HS42", Vec({1, 1, 1, 1}), Vec({2, 2, 0.6 * kSqrt2, 0.8 * kSqrt2}), 14 - 5 * kSqrt2,
      [](const V& x) {
        return V{x[0] - 1, x[1] - 2, x[2] - 3, x[3] - 4};
      },
      [](const V& x) {
        return V{x[0] - 2, Square(x[2]) + Square(x[3]) - 2};
      }));
  all->push_back(Formula(
      "HS46", Vec({kSqrt2 / 2, 1.75, 0.5, 2, 2}), ones, 0,
      [](const V& x) {
        return V{x[0] - x[1], x[2] - 1, Square(x[3] - 1), Cube(x[4] - 1)};
      },
      [](const V& x) {
        return V{Square(x[0]) * x[3] + sin(x[3] - x[4]) - 1,
                 x[1] + Fourth(x[2]) * Square(x[3]) - 2};
      },
      {}, kFlat));
  all->push_back(Formula(
      "HS48", Vec({3, 5, -3, 2, -2}), ones, 0,
      [](const V& x) {
        return V{x[0] - 1, x[1] - x[2], x[3] - x[4]};
      },
      [](const V& x) {
        return V{x[0] + x[1] + x[2] + x[3] + x[4] - 5, x[2] - 2 * (x[3] + x[4]) + 3};
      }));
  all->push_back(Formula(
      "HS49", Vec({10, 7, 2, -3, 0.8}), ones, 0,
      [](const V& x) {
        return V{x[0] - x[1], x[2] - 1, Square(x[3] - 1), Cube(x[4] - 1)};
      },
      [](const V& x) {
        return V{x[0] + x[1] + x[2] + 4 * x[3] - 7, x[2] + 5 * x[4] - 6};
      },
      {}, kFlat));
  all->push_back(Formula(
      "HS50", Vec({35, -31, 11, 5, -5}), ones, 0,
      [](const V& x) {
        return V{x[0] - x[1], x[1] - x[2], Square(x[2] - x[3]), x[3] - x[4]};
      },
      [](const V& x) {
        return V{x[0] + 2 * x[1] + 3 * x[2] - 6, x[1] + 2 * x[2] + 3 * x[3] - 6,
                 x[2] + 2 * x[3] + 3 * x[4] - 6};
      },
      {}, kFlat));
  const auto r51 = [](const V& x) { return V{x[0] - x[1], x[1] + x[2] - 2, x[3] - 1, x[4] - 1}; };
  const auto LinearRows = [](double first) {
    return [=](const V& x) {
      return V{x[0] + 3 * x[1] - first, x[2] + x[3] - 2 * x[4], x[1] - x[4]};
    };
  };
  all->push_back(Formula("HS51", Vec({2.5, 0.5, 2, -1, 0.5}), ones, 0, r51, LinearRows(4)));
  all->push_back(Formula(
      "HS52", 2 * ones, Vec({-33, 11, 180, -158, 11}) / 349, 0.5 * 1859 / 349,
      [](const V& x) {
        return V{4 * x[0] - x[1], x[1] + x[2] - 2, x[3] - 1, x[4] - 1};
      },
      LinearRows(0)));
  std::vector<Bound> within_10;
  for (int i = 0; i < 5; ++i) within_10.push_back({i, i, -10, 10});
  all->push_back(Formula("HS53", 2 * ones, Vec({-33, 11, 27, -5, 11}) / 43, 0.5 * 176 / 43, r51,
                         LinearRows(0), within_10));
  all->push_back(Formula(
      "HS60", Vec({2, 2, 2}), Vec({1.104859024, 1.196674194, 1.535262257}), 0.5 * 0.03256820025,
      [](const V& x) {
        return V{x[0] - 1, x[0] - x[1], Square(x[1] - x[2])};
      },
      [](const V& x) { return V{x[0] * (1 + Square(x[1])) + Fourth(x[2]) - (4 + 3 * kSqrt2)}; },
      {within_10.begin(), within_10.begin() + 3}));
  all->push_back(Formula(
      "HS77", 2 * ones, Vec({1.166172, 1.182111, 1.380257, 1.506036, 0.6109203}), 0.5 * 0.24150513,
      [](const V& x) {
        return V{x[0] - 1, x[0] - x[1], x[2] - 1, Square(x[3] - 1), Cube(x[4] - 1)};
      },
      [](const V& x) {
        return V{Square(x[0]) * x[3] + sin(x[3] - x[4]) - 2 * kSqrt2,
                 x[1] + Fourth(x[2]) * Square(x[3]) - (8 + kSqrt2)};
      },
      {}, kPrinted));
  all->push_back(Formula(
      "HS79", 2 * ones, Vec({1.191127, 1.362603, 1.472818, 1.635017, 1.679081}), 0.5 * 0.0787768209,
      [](const V& x) {
        return V{x[0] - 1, x[0] - x[1], x[1] - x[2], Square(x[2] - x[3]), Square(x[3] - x[4])};
      },
      [](const V& x) {
        return V{x[0] + Square(x[1]) + Cube(x[2]) - (2 + 3 * kSqrt2),
                 x[1] - Square(x[2]) + x[3] - (2 * kSqrt2 - 2), x[0] * x[4] - 2};
      },
      {}, kPrinted));
}

void AddBounded(std::vector<TextbookProblem>* all) {
  // HS2: Rosenbrock's valley cut off at x2 >= 1.5.
  const double a = std::sqrt(598.0 / 1200), b = 400 * a * a * a;
  const double x1 = 2 * a * std::cos(std::acos(1 / b) / 3);
  const double r1 = 10 * (1.5 - x1 * x1), r2 = 1 - x1;
  all->push_back(Formula("HS2", Vec({1.4, 1.7}), Vec({x1, 1.5}), 0.5 * (r1 * r1 + r2 * r2),
                         [](const V& x) {
                           return V{10 * (x[1] - Square(x[0])), 1 - x[0]};
                         },
                         None, {{1, 1, 1.5, std::numeric_limits<double>::infinity()}}));
  // A plane and an active bound: x1 = 1/2, then x2 - 2 = x3 on x2 + x3 = 5/2.
  all->push_back(Formula(
      "PlaneWithActiveBound", Vec({0, 0, 0}), Vec({0.5, 2.25, 0.25}), 0.5 * (2.25 + 0.125),
      [](const V& x) {
        return V{x[0] - 2, x[1] - 2, x[2]};
      },
      [](const V& x) { return V{x[0] + x[1] + x[2] - 3}; },
      {{0, 0, -std::numeric_limits<double>::infinity(), 0.5}}));
}

// Bounds that are met on the way or in the end, with curved constraints and in numbers.
void AddBoxes(std::vector<TextbookProblem>* all) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto from_2_1 = [](const V& x) { return V{x[0] - 2, x[1] - 1}; };
  const auto circle = [](const V& x) { return V{Square(x[0]) + Square(x[1]) - 1}; };
  const double height = std::sqrt(0.75);
  all->push_back(Formula("CircleWithActiveBound", Vec({-0.1, 0.8}), Vec({0.5, height}),
                         0.5 * (2.25 + (1 - height) * (1 - height)), from_2_1, circle,
                         {{0, 0, -kNone, 0.5}, {1, 1, 0, kNone}}));
  // From the start the circle is reached at x1 = 0.95, its upper bound, then left for 2/sqrt(5).
  const double root5 = std::sqrt(5.0);
  all->push_back(Formula("CircleAlongABoundThatIsLeft", Vec({0.95, 0.05}), Vec({2, 1}) / root5,
                         0.5 * (root5 - 1) * (root5 - 1), from_2_1, circle,
                         {{0, 0, -kNone, 0.95}, {1, 1, 0, 1}}));
  // x_i = i - t where 0 <= x_i <= 2 allows it, and t = 2.25 makes the sum 4.5.
  std::vector<Bound> box;
  for (int i = 0; i < 5; ++i) box.push_back({i, i, 0, 2});
  const VectorXd solution = Vec({0, 0, 0.75, 1.75, 2});
  all->push_back(Formula(
      "PlaneAcrossABox", 0.9 * VectorXd::Ones(5), solution,
      0.5 * (solution - Vec({1, 2, 3, 4, 5})).squaredNorm(),
      [](const V& x) {
        return V{x[0] - 1, x[1] - 2, x[2] - 3, x[3] - 4, x[4] - 5};
      },
      [](const V& x) { return V{x[0] + x[1] + x[2] + x[3] + x[4] - 4.5}; }, box));
}

// The point of the unit circle nearest to (2, 1), the circle said three times over.
void AddRedundant(std::vector<TextbookProblem>* all) {
  const double root5 = std::sqrt(5.0);
  all->push_back(Formula(
      "CircleThrice", Vec({1.5, -0.5}), Vec({2, 1}) / root5, 0.5 * (root5 - 1) * (root5 - 1),
      [](const V& x) {
        return V{x[0] - 2, x[1] - 1};
      },
      [](const V& x) {
        const Dual2 circle = Square(x[0]) + Square(x[1]) - 1;
        return V{circle, 2 * circle, circle * (3 + x[0])};
      }));
}

// A planar four-bar (crank 1, coupler 2.5, rocker 2, base 3, absolute angles). Its coupler's
// middle is pulled to a point off its path along the path's normal, at the distance 0.1.
void AddFourBar(std::vector<TextbookProblem>* all) {
  const auto loop = [](const V& q) {
    return V{cos(q[0]) + 2.5 * cos(q[1]) - 2 * cos(q[2]) - 3,
             sin(q[0]) + 2.5 * sin(q[1]) - 2 * sin(q[2])};
  };
  const auto middle = [](const V& q) {
    return V{cos(q[0]) + 1.25 * cos(q[1]), sin(q[0]) + 1.25 * sin(q[1])};
  };
  // Closed at the crank angle 1: the circles about the crank pin and the rocker's foot meet.
  const double crank = 1.0;
  const Eigen::Vector2d pin(std::cos(crank), std::sin(crank)), foot(3, 0);
  const Eigen::Vector2d across = foot - pin;
  const double d = across.norm(), along = (2.5 * 2.5 - 2 * 2 + d * d) / (2 * d);
  const double up = std::sqrt(2.5 * 2.5 - along * along);
  const Eigen::Vector2d joint =
      pin + along * across / d + up * Eigen::Vector2d(-across.y(), across.x()) / d;
  const Eigen::Vector2d coupler = joint - pin, rocker = joint - foot;
  const VectorXd q =
      Vec({crank, std::atan2(coupler.y(), coupler.x()), std::atan2(rocker.y(), rocker.x())});
  // Velocity of the middle: pin' + half (joint' - pin'), joint' across the rocker.
  const Eigen::Vector2d pin_rate(-pin.y(), pin.x()), joint_direction(-rocker.y(), rocker.x());
  const double rate = coupler.dot(pin_rate) / coupler.dot(joint_direction);
  const Eigen::Vector2d tangent = 0.5 * (pin_rate + rate * joint_direction);
  const Eigen::Vector2d normal = Eigen::Vector2d(-tangent.y(), tangent.x()).normalized();
  const Eigen::Vector2d target = pin + 0.5 * coupler + 0.1 * normal;
  all->push_back(Formula(
      "FourBarPulledOffItsPath", q + Vec({0.2, -0.1, 0.1}), q, 0.005,
      [=](const V& angles) {
        const V p = middle(angles);
        return V{p[0] - target.x(), p[1] - target.y()};
      },
      loop));
}

// x = (unit quaternion w x y z; s). The vector u = R a is to come as near as can be to b while it
// stays on the cone n'u = cos(theta); s follows as s = b'u. Turning about u is free.
class ConeProblem final : public ConstrainedLeastSquares {
 public:
  ConeProblem() : ConstrainedLeastSquares({5, 4, 4, 1}) {}

  void Plus(const VectorXd& x, const VectorXd& dx, VectorXd* x_plus) const override {
    const Eigen::Quaterniond q(x[0], x[1], x[2], x[3]);
    const Eigen::Vector3d turn = dx.head<3>();
    const double angle = turn.norm();
    const double s = angle > 1e-8 ? std::sin(angle / 2) / angle : 0.5;
    const Eigen::Quaterniond step(std::cos(angle / 2), s * turn.x(), s * turn.y(), s * turn.z());
    const Eigen::Quaterniond moved = (step * q).normalized();
    const double slack = x[4] + dx[3];
    *x_plus << moved.w(), moved.x(), moved.y(), moved.z(), slack;
  }

  void Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c, MatrixXd* C) override {
    const Eigen::Vector3d u = Rotated(x);
    if (r) *r << u - b, x[4] - b.dot(u);
    if (c) *c << n.dot(u) - cos_theta;
    // du = dphi x u, hence d(a'u) = (u x a)' dphi
    if (J) {
      J->setZero();
      for (int i = 0; i < 3; ++i) {
        J->block<1, 3>(i, 0) = u.cross(Eigen::Vector3d::Unit(i)).transpose();
      }
      J->block<1, 3>(3, 0) = -u.cross(b).transpose();
      (*J)(3, 3) = 1;
    }
    if (C) *C << u.cross(n).transpose(), 0;
  }

  static Eigen::Vector3d Rotated(const VectorXd& x) {
    return Eigen::Quaterniond(x[0], x[1], x[2], x[3]) * Eigen::Vector3d::UnitX();
  }
  // u = cos(theta) n + sin(theta) (the direction of b across n); the objective there.
  static double LeastObjective() {
    const Eigen::Vector3d across = (b - n * n.dot(b)).normalized();
    const Eigen::Vector3d u = cos_theta * n + std::sqrt(1 - cos_theta * cos_theta) * across;
    return 0.5 * (u - b).squaredNorm();
  }

  static inline const Eigen::Vector3d b{0.3, 0.9, -0.5};
  static inline const Eigen::Vector3d n{0, 0, 1};
  static constexpr double cos_theta = 0.4;
};

std::vector<TextbookProblem> MakeAll() {
  std::vector<TextbookProblem> all;
  AddHockSchittkowski(&all);
  AddBounded(&all);
  AddBoxes(&all);
  AddRedundant(&all);
  AddFourBar(&all);
  all.push_back({"QuaternionOnACone", [] { return std::make_unique<ConeProblem>(); },
                 Vec({1, 0, 0, 0, 0}), VectorXd(), ConeProblem::LeastObjective()});
  return all;
}

// Constraints that no point meets.
std::vector<TextbookProblem> MakeInfeasible() {
  constexpr double kFree = -std::numeric_limits<double>::infinity();
  const auto pull = [](const V& x) { return V{x[1] - 1}; };
  const auto circle_and_far_line = [](const V& x) {
    return V{Square(x[0]) + Square(x[1]) - 1, x[0] - 3};
  };
  const auto parallel_lines = [](const V& x) { return V{x[0] + x[1] - 1, 2 * (x[0] + x[1]) - 4}; };
  const auto line = [](const V& x) { return V{x[0] + x[1] - 3}; };
  const auto never_zero = [](const V& x) { return V{Square(x[0]) + 1}; };
  return {
      Formula("CircleAndFarLine", Vec({0.5, 0.5}), {}, 0, pull, circle_and_far_line),
      Formula("ParallelLines", Vec({0.5, 0.5}), {}, 0, pull, parallel_lines),
      Formula("LineBeyondBounds", Vec({0.5, 0.5}), {}, 0, pull, line,
              {{0, 0, kFree, 1}, {1, 1, kFree, 1}}),
      Formula("ParabolaAboveZero", Vec({0.5, 0.5}), {}, 0, pull, never_zero),
  };
}

}  // namespace

void FormulaProblem::Evaluate(const VectorXd& x, VectorXd* r, MatrixXd* J, VectorXd* c,
                              MatrixXd* C) {
  const std::vector<Dual2> variables = Variables(x);
  Write(residuals_(variables), r, J);
  Write(constraints_(variables), c, C);
}

void FormulaProblem::Curvature(const VectorXd& x, const VectorXd& mu, MatrixXd* S) {
  const std::vector<Dual2> variables = Variables(x);
  S->setZero();
  for (const Dual2& r : residuals_(variables)) *S += r.value * r.hessian;
  const std::vector<Dual2> c = constraints_(variables);
  for (size_t j = 0; j < c.size(); ++j) *S += mu[j] * c[j].hessian;
}

const std::vector<TextbookProblem>& TextbookProblems() {
  static const std::vector<TextbookProblem> all = MakeAll();
  return all;
}

const TextbookProblem& FindProblem(const std::string& name) {
  for (const TextbookProblem& problem : TextbookProblems()) {
    if (problem.name == name) return problem;
  }
  throw std::invalid_argument("no test problem is called " + name);
}

const std::vector<TextbookProblem>& InfeasibleProblems() {
  static const std::vector<TextbookProblem> all = MakeInfeasible();
  return all;
}

}  // namespace vmech::textbook
